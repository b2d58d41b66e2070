"""The painting factory of the paper, as the demo's site."""
