"""What people are told when a room cannot do what they ask."""

from __future__ import annotations

INTERRUPTED = "The program could not be reached just now. What was typed stays in the browser and follows."
PROGRAM_FULL = (
    "The program is full: it may have 8 MiB and 5,000 steps. Remove steps, or make a second program of a part."
)
TOO_MANY_PAGES = "This program has been changed from 20,000 pages, which is all that it keeps. Copy it and go on there."
TOO_COSTLY = "A change of yours costs more time than the changes of a program do. Close other copies of the page."
