"""What every API of VIPO asks of a request, and says in the OpenAPI file."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest

from registry.models import User


def sends(*content_types: str) -> dict[str, Any]:
    """Say in the OpenAPI file that a call answers with something else than JSON."""
    return {"responses": {200: {"content": {name: {"schema": {"type": "string"}} for name in content_types}}}}


def signed_in(request: HttpRequest) -> User:
    """Return who asks; the API lets nobody else through."""
    assert isinstance(request.user, User)
    return request.user
