"""A program that is being edited: each look at it follows only what has changed since the last."""

from __future__ import annotations

from editor.language.compiled import Compiled, Look, look_at
from editor.language.remembering import Memories
from editor.language.surroundings import Surroundings


class EditedProgram:
    """One program, looked at again and again; it says of each document just what `compile_document` says.

    Documents are plain JSON and are not changed in place: a step that is the same object as at the last look is
    the same step. What is remembered is no more than what the last look needed. Not to be used from two threads
    at once.
    """

    def __init__(self) -> None:
        """Know nothing yet."""
        self._memories = Memories()

    def look(self, document: object, surroundings: Surroundings) -> Look:
        """Read and check the document as it is now."""
        return look_at(document, surroundings, self._memories)

    def compile(self, document: object, surroundings: Surroundings) -> Compiled:
        """Return all forms of the program as it is now."""
        return self.look(document, surroundings).compiled()
