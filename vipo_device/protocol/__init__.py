"""The messages between devices and VIPO: topics, JSON, what may be wrong with them, keys, and the MQTT client."""
