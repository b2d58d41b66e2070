"""SPARQL over a site's descriptions, in a process that can be ended."""
