"""A type that the API describes and does not check: for large answers that our own code has just made."""

from __future__ import annotations

from typing import Any

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema


class Shown:
    """`Annotated[Any, Shown(Shape)]` looks like `Shape` in the OpenAPI file and passes through as it is.

    Reading a rehearsal of 700 kB a second time would only cost time; tests hold such values against their shapes.
    """

    def __init__(self, shape: Any) -> None:
        self._shape = shape

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Return the shape for JSON, from which descriptions are made, and anything at all for Python's values."""
        return core_schema.json_or_python_schema(
            json_schema=handler.generate_schema(self._shape),
            python_schema=core_schema.any_schema(),
            serialization=core_schema.plain_serializer_function_ser_schema(_as_it_is),
        )


def _as_it_is(value: Any) -> Any:
    return value
