"""python -m cdpr_struct: the program without its script."""

from cdpr_struct.cli.main import main

if __name__ == "__main__":
    main()
