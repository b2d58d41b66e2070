"""One owner for each site: it carries runs and floor out in memory, and writes what came of it turn by turn."""
