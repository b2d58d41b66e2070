"""Tree → plan: the flat instructions that a run carries out."""
