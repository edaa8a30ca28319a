"""Speed against error, coverage of the error bars; run by hand, see README.md."""
