"""What people are told when a room cannot do what they ask."""

from __future__ import annotations

from editor.documents.yjs_updates import MOST_CLIENTS_EVER

INTERRUPTED = "The program could not be reached just now. What was typed stays in the browser and follows."
TOO_MANY_PAGES = (
    f"This program has been changed from {MOST_CLIENTS_EVER:,} pages, which is all that it keeps. "
    "Copy it and go on there."
)
TOO_COSTLY = "A change of yours costs more time than the changes of a program do. Close other copies of the page."
