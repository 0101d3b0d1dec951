"""Fits friction, cutting and puncture force to force-depth curves; see docs/calibration.md."""
import argparse
import sys
from pathlib import Path

from curves import DataError, from_run, read_curves, write_curves
from fit import calibrate
from report import draw, print_table, write_csv, write_options
from synthetic import SEED, note, synthetic_curves

ROOT = Path(__file__).resolve().parents[2]
USAGE, DATA, OUTPUT = 64, 65, 74  # exit codes, those of the program
FIXABLE = {"dynamic": "N/m", "viscous": "N s/m^2", "cutting": "N", "dynamic_withdraw": "N/m",
           "viscous_withdraw": "N s/m^2"}


class Parser(argparse.ArgumentParser):
    def error(self, message):
        fail(USAGE, message)


def fail(code, message):
    print(f"calibrate: error: {message}", file=sys.stderr)
    raise SystemExit(code)


def arguments():
    parser = Parser(prog="calibrate", description=__doc__)
    parser.add_argument("csv", nargs="*", help="columns time,depth,force[,velocity][,run], SI")
    parser.add_argument("--name", help="results go to results/calibration/NAME (first CSV's name)")
    parser.add_argument("--output", type=Path, help="results go to this folder instead")
    parser.add_argument("--entry", type=float, metavar="M",
                        help="depth the path is counted from (default: the puncture, else 0)")
    parser.add_argument("--depths", type=float, nargs=2, metavar="M", default=(0.0, float("inf")),
                        help="fit only these paths from the entry")
    parser.add_argument("--no-withdrawal", action="store_true", help="fit the advance alone")
    for name, unit in FIXABLE.items():
        parser.add_argument(f"--{name.replace('_', '-')}", type=float, metavar="X",
                            help=f"fix {name} at this value [{unit}]")
    parser.add_argument("--from-run", nargs=2, metavar=("RUN.h5", "OUT.csv"),
                        help="write a run's curve as CSV and stop")
    parser.add_argument("--needle", default="", help="which needle of --from-run (else the first)")
    parser.add_argument("--synthetic", metavar="OUT.csv", help="write made-up curves and stop")
    parser.add_argument("--seed", type=int, default=SEED, help="seed of --synthetic")
    return parser.parse_args()


def fixed_values(args):
    fixed = {name: getattr(args, name) for name in FIXABLE if getattr(args, name) is not None}
    for name, value in fixed.items():
        if not 0.0 <= value < float("inf"):
            fail(USAGE, f"--{name.replace('_', '-')} must be 0 or larger, it is {value}")
    return fixed


def fit_files(args):
    fixed = fixed_values(args)
    curves = [curve for file in args.csv for curve in read_curves(file, len(args.csv) > 1)]
    result = calibrate(curves, fixed, args.entry, args.depths, not args.no_withdrawal)
    folder = args.output or ROOT / "results/calibration" / (args.name or Path(args.csv[0]).stem)
    folder.mkdir(parents=True, exist_ok=True)
    print_table(result)
    write_csv(folder / "fit.csv", result)
    write_options(folder / "fit.opts", result, args.csv)
    draw(folder / "fit.png", curves, result)
    print(f"wrote {folder}/fit.csv, fit.opts and fit.png\n"
          f"use: trocar -options_file SCENE.opts -options_file {folder}/fit.opts")


def main():
    args = arguments()
    try:
        if args.synthetic:
            write_curves(args.synthetic, synthetic_curves(args.seed), note(args.seed))
        elif args.from_run:
            write_curves(args.from_run[1], [from_run(args.from_run[0], args.needle)],
                         f"From {args.from_run[0]} by scripts/calibrate --from-run.")
        elif args.csv:
            fit_files(args)
        else:
            fail(USAGE, "no CSV file given, see --help")
    except DataError as failure:
        fail(DATA, failure)
    except OSError as failure:
        fail(OUTPUT, f"{failure.filename or 'output'}: cannot be written ({failure.strerror})")


main()
