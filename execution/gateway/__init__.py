"""Between MQTT and the database: what devices say goes in, commands and stops go out."""
