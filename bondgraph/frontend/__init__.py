"""From text to the syntax tree and back to text; knows no mathematics and no element kinds."""
