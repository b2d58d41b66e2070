"""Comments beside a program's document: threads on its constructs, arrows and places, with answers and mentions."""
