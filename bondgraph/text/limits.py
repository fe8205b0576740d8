"""How much a file, a device or a page may ask for; docs/limits.md says the same to people.

Far beyond what machines need. What goes further is refused with its place and a remedy, so that
no text makes a command take all memory, or run until somebody stops it.
"""

# Models
MODEL_BYTES = 200_000_000  #: of a file; a model of a million bonds has about 50 MB
PARTS = 3_000_000  #: names and statements of a whole model; a million bonds are within it
UNROLLED = 20_000  #: names of arrays and statements of loops that one instance unrolls itself
BRACKETS = 100  #: inside each other, or blocks
OPERATORS = 200  #: inside each other, in one expression
NAME_LETTERS = 100  #: of one name; files are called by it
DIGITS = 400  #: of a number
SYNTAX_ERRORS = 40  #: after which a file is not read on
SHOWN = 100  #: findings that are shown of one kind, and so many errors
TABLE_BYTES = 20_000_000  #: of a file with a table
TABLE_NUMBERS = 200_000  #: in it: residuals have all of them in their code
INCIDENCE_CELLS = 1_000_000  #: of an incidence table, rows times columns
INCIDENCE_MARKS = 50_000  #: of these cells that are not empty

# Scenarios, maps, tunings
SCENARIO_BYTES = 10_000_000
MAP_BYTES = 1_000_000
TUNING_BYTES = 20_000_000
NESTED = 50  #: tables or arrays inside each other, in TOML and JSON
SCENARIO_FAULTS = 500
SCENARIO_CONTROLLERS = 200
FAULT_TIMES = 20_000  #: that a fault comes and goes; every time is a new start of integration
RUN_VALUES = 100_000_000  #: samples times signals of a simulated log, all of them in memory

# Logs and streams
COLUMNS = 4_000  #: of a log
RATE = 100_000_000_000  #: samples a second, and rad/s of a filter; and at least its inverse
LINE_BYTES = 1 << 20  #: of a line of samples

# The live page
PAGES = 600
CONNECTIONS = 700  #: below the 1024 files that a process may usually have open
WISH_BYTES = 4096
WISHES_A_SECOND = 10  #: of one page; more wait there
WISHES = 64  #: of all pages that may wait
INJECTED = 30  #: faults of the virtual machine at once

# The workbench
EDIT_BYTES = 1_000_000  #: of a text that a page edits
EDITORS = 8  #: pages at once, each with a process of its own
KEYS_A_SECOND = 40  #: messages of one page; more wait there
