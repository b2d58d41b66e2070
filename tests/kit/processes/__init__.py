"""Processes of Python that tests start, forked from one that has loaded the product: loading takes seconds."""
