"""What the mirror measures: what devices take for their commands beside what their copies take, and what follows."""
