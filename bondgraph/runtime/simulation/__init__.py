"""The virtual machine: a bond graph that runs, with inputs, controllers, instruments and faults."""
