"""What the sources, their layout and the pages say about themselves is held to what is there."""
