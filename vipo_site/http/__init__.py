"""How the apps' HTTP is put together: the API, refusals, headers, health, the Thing directory's addresses."""

MOST_MESSAGE_BYTES = 16 * 1024 * 1024
"""Of one message of a socket, above what any socket of ours allows; the Dockerfile gives it to Daphne."""
