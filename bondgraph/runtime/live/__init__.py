"""A virtual machine in step with a monitored one, and the page that shows both."""
