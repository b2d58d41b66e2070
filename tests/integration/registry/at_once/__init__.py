"""Two people at each decision at once, on PostgreSQL: one wins, nothing is half done, the other is told what happened.

Both press while the test holds the row or table that they need, in a known order, and then it lets go.
"""
