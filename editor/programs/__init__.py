"""Programs as rows: their documents, versions, scripts, checks, and the library of functions."""
