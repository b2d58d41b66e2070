"""Tests beside programs: kept with them, carried out by the workers of rehearsals, and what came of it."""
