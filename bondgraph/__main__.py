"""`python -m bondgraph` is the command `bondgraph`."""

import sys

from bondgraph.cli.main import main

sys.exit(main())
