"""The page that paper.py writes: results, verdicts, tables and pictures of each entry."""
