"""`caretree robot doctor`: what a robot behind a ROS 1 master lacks, before anything moves."""

from __future__ import annotations

import argparse


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command to the command line; `main` runs it."""
    parser = subparsers.add_parser(
        "robot",
        help="say what a robot behind a ROS 1 master lacks, before anything moves",
        description="doctor: look at the master, at every topic and action of the site, their kinds, rates, ages and "
        "frames, and say what is wrong with each.  Nothing moves.  ROS_MASTER_URI says where the master is.",
    )
    parser.add_argument("what", metavar="WHAT", choices=("doctor",), help="doctor")
    parser.add_argument("--site", default="baxter", metavar="FILE", help="site file (default: baxter)")
    parser.add_argument("--seconds", type=float, default=2.0, metavar="S", help="how long to listen (default: 2)")
    parser.set_defaults(main=main)


def main(options: argparse.Namespace) -> int:
    """Print the findings; 0 where nothing is wrong, else 1.

    Raises:
        CaretreeError: the site file is not as it should be, or ROS is missing.
    """
    from ...sim.ros1.doctor import examine

    findings = examine(options.site, options.seconds)
    for finding in findings:
        print(finding)
    wrong = sum(not finding.well for finding in findings)
    print(f"{wrong} of {len(findings)} findings ask for something" if wrong else "the robot is whole")
    return 1 if wrong else 0
