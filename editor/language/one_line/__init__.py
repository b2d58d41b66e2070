"""A value as one line of text, as the inspector's field has it: read, and printed."""
