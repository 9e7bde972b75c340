"""Numbers that docs/reproduction.md and its appendix tell, a module each sort: values of slots from tables."""
