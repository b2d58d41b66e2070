"""What is measured; each line that is printed is one JSON object."""
