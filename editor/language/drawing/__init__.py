"""Tree → document: where the steps of a script stand on the map, and what stays of the drawing before."""
