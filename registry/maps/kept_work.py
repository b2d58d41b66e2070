"""What was worked out of maps, kept for as many cells as memory may hold: large maps push others out."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

Made = TypeVar("Made")


class KeptWork(Generic[Made]):
    """The newest results, for so many cells in all; of one that is larger than that, only itself.

    One is made at a time: ten who ask for the same large map at once cost as much as one.
    """

    def __init__(self, most_cells: int) -> None:
        self._most_cells = most_cells
        self._kept: OrderedDict[Hashable, tuple[int, Made]] = OrderedDict()
        self._looking, self._making = threading.Lock(), threading.Lock()

    @property
    def cells(self) -> int:
        """How many cells the results that are kept have."""
        return sum(cells for cells, _ in self._kept.values())

    def get(self, key: Hashable, make: Callable[[], Made], cells_of: Callable[[Made], int]) -> Made:
        """Return the result of this key, made unless it is kept."""
        if (found := self._find(key)) is not None:
            return found[1]
        with self._making:
            if (found := self._find(key)) is not None:
                return found[1]
            made = make()
            self._keep(key, cells_of(made), made)
        return made

    def _find(self, key: Hashable) -> tuple[int, Made] | None:
        with self._looking:
            if key in self._kept:
                self._kept.move_to_end(key)
            return self._kept.get(key)

    def _keep(self, key: Hashable, cells: int, made: Made) -> None:
        with self._looking:
            self._kept[key] = (cells, made)
            while self.cells > self._most_cells and len(self._kept) > 1:
                self._kept.popitem(last=False)
