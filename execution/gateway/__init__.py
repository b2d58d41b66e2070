"""MQTT in and out of the server."""
