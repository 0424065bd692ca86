"""`caretree learn pregrasp data|train|reward|evaluate`; `data` and `train` go on where they were interrupted."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ...sim.command_line import CommandParser, seed, whole_number
from ...sim.errors import CaretreeError
from ...sim.scene.gown import GOWNS, HELD_OUT_GOWNS
from ..seeds import span_of_seeds
from ..shards import add_cluster_options
from .numbers import ORACLES, PHYSICS


def parser() -> argparse.ArgumentParser:
    """The command line."""
    top = CommandParser(prog="caretree learn pregrasp")
    sub = top.add_subparsers(dest="command", required=True)
    data = sub.add_parser("data", help="gowns that hang from one hand, and what the oracle's grasps come to")
    data.add_argument("folder", metavar="DIR", help="made when it is not there")
    data.add_argument(
        "--seeds", type=span_of_seeds, default=span_of_seeds("100-199"), metavar="A-B", help="default 100-199"
    )
    data.add_argument("--gown", choices=(*GOWNS, *HELD_OUT_GOWNS), help="of all states (default: the seed draws it)")
    data.add_argument(
        "--deep", action="store_true", help="gowns held by the middle of the neckline, which meet themselves"
    )
    data.add_argument(
        "--pixels",
        type=whole_number,
        choices=range(1, 6),
        default=5,
        help="that the oracle tries in a view (default 5)",
    )
    data.add_argument(
        "--oracle",
        choices=ORACLES,
        default="all",
        help="which actions it tries: all, no more than tell the ceiling, some near the corner to train on, or none",
    )
    data.add_argument(
        "--physics",
        choices=PHYSICS,
        default="identified",
        help="whose cloth: identified from a clip of it, true, tuned (baseline 4) or random (baseline 5)",
    )
    add_cluster_options(data)
    train = sub.add_parser("train", help="train the policy and write it as ONNX")
    train.add_argument("data", type=Path, metavar="DATA", help="folder of `data`: its successes are demonstrations")
    train.add_argument("--out", required=True, type=Path, metavar="DIR", help="checkpoint, record and pregrasp.onnx")
    train.add_argument("--steps", type=whole_number, default=400, metavar="N", help="on demonstrations (default 400)")
    train.add_argument(
        "--grasp-steps",
        type=whole_number,
        default=6000,
        metavar="N",
        help="of the network of what fingers take (default 6000)",
    )
    train.add_argument("--trials", type=int, default=1000, metavar="N", help="active trials after them (default 1000)")
    train.add_argument("--seed", type=seed, default=0, metavar="N", help="default 0")
    train.add_argument("--grasp-only", action="store_true", help="ablation: a policy of direct grasps alone")
    train.add_argument(
        "--apart", type=Path, metavar="DATA", help="other states, in which it is tried to say how sure it can be"
    )
    train.add_argument(
        "--reward", type=Path, metavar="FILE", help="network that tells the trials' success by pictures, not the truth"
    )
    train.add_argument("--no-demonstrations", action="store_true", help="ablation: active trials alone")
    reward = sub.add_parser("reward", help="train what tells success by the pictures after an action, and test it")
    reward.add_argument("data", type=Path, metavar="DATA", help="folder of `data --oracle drawn`")
    reward.add_argument("--test", required=True, type=Path, metavar="DATA", help="a folder of other states")
    reward.add_argument("--out", required=True, type=Path, metavar="FILE", help="the ONNX file, for `train --reward`")
    reward.add_argument("--steps", type=whole_number, default=4000, metavar="N", help="default 4000")
    reward.add_argument("--seed", type=seed, default=0, metavar="N", help="default 0")
    test = sub.add_parser("evaluate", help="ceiling of the oracle, success of a policy, agreement with PyBullet")
    test.add_argument("data", type=Path, metavar="DATA", help="folder of `data` that no training saw")
    test.add_argument("--policy", type=Path, metavar="FILE", help="a pregrasp.onnx")
    test.add_argument(
        "--against", type=Path, metavar="FILE", help="another pregrasp.onnx: which of both wins the same states"
    )
    test.add_argument(
        "--engine", choices=("spring", "bullet"), default="spring", help="that tries the policy (default spring)"
    )
    test.add_argument(
        "--bullet", type=whole_number, default=0, metavar="N", help="repeat N attempts in PyBullet (0.5 s each)"
    )
    test.add_argument("--seed", type=seed, default=0, metavar="N", help="of which attempts these are (default 0)")
    test.add_argument("--out", type=Path, metavar="FILE", help="also write the tables, Markdown")
    return top


def main(argv: list[str]) -> int:
    """Run one command.

    Raises:
        CaretreeError: the input cannot be used.
    """
    options = parser().parse_args(argv)
    if options.command == "data":
        from .dataset import make_dataset

        print(
            make_dataset(
                options.folder,
                options.seeds,
                _say,
                gown=options.gown,
                deep=options.deep,
                pixels=options.pixels,
                oracle=options.oracle,
                physics=options.physics,
                jobs=options.jobs,
                address=options.address,
            )
        )
    elif options.command == "train":
        _train(options)
    elif options.command == "reward":
        _reward(options)
    else:
        _evaluate(options)
    return 0


def _use_torch(command: str) -> None:
    try:
        import torch  # pyright: ignore[reportMissingImports] - in the extra `learn`
    except ImportError as error:
        raise CaretreeError(
            f"`caretree learn pregrasp {command}` needs PyTorch: pip install 'caretree[learn]'"
        ) from error
    torch.set_num_threads(1)  # as the other trainings: bit by bit the same on any number of cores


def _reward(options: argparse.Namespace) -> None:
    if options.out.is_dir() or not options.out.parent.is_dir():
        raise CaretreeError(f"{options.out}: no file can be written there, it must be one in a folder that exists")
    _use_torch("reward")
    from .reward import make_reward

    print(make_reward(options.data, options.test, options.out, steps=options.steps, seed=options.seed, say=_say))


def _train(options: argparse.Namespace) -> None:
    _use_torch("train")
    from .train import Plan, train

    plan = Plan(
        steps=0 if options.no_demonstrations else options.steps,
        grasp_steps=options.grasp_steps,
        trials=max(0, options.trials),
        grasp_only=options.grasp_only,
        seed=options.seed,
    )
    print(train(options.data, options.out, plan, _say, options.apart, options.reward))


def _evaluate(options: argparse.Namespace) -> None:
    from .ceiling import table
    from .dataset import load_dataset

    if options.against and not options.policy:
        raise CaretreeError("--against compares two policies: name the other one with --policy")
    data = load_dataset(options.data)
    texts = [table(data)] if data.tells_ceiling else []
    if options.policy:
        from .evaluate import policy_table

        texts.append(policy_table(data, options.policy, _say, engine=options.engine, against=options.against))
    if options.bullet > 0:
        from .agreement import agreement_table

        texts.append(agreement_table(data, options.bullet, options.seed, _say))
    text = "\n\n".join(texts)
    print(text)
    if options.out:
        options.out.write_text(text + "\n", encoding="utf-8")


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
