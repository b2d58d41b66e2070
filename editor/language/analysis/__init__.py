"""What is found by following a tree along its paths, and the memos that spare a second walk."""
