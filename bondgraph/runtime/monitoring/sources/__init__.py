"""Where samples come from: files, standard input, a serial port, an MQTT broker."""
