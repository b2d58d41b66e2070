"""Programs as rows: their versions, scripts and checks, and the library of functions."""
