"""Tests of the virtual machine: state equations, scenarios and runs, each against another route."""
