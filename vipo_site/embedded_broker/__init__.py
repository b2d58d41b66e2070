"""The MQTT broker that runs inside the process, with VIPO's own rules about who may do what."""
