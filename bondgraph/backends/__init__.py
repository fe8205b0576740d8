"""From the residual program to text and to files; knows templates, knows no algebra."""
