"""``python -m ratd``: see `ratd.command`."""

from ratd.command import main

if __name__ == "__main__":
    main(prog_name="python -m ratd")
