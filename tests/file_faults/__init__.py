"""What becomes of files when a process is killed, the power fails, or the disk does.

A library between Python and the C library (`interpose.c`) counts what a command does to files, and
at each of these operations in turn kills the command or has the operation fail. Then what stands in
the folder is looked at, and the command is run again. docs/trust.md says what is promised.
"""
