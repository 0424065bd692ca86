"""report.html: one page that reads like a short lab report."""

from __future__ import annotations

import re
from html import escape

from .findings import EffectFinding, Gap, Verdict
from .pictures import Curve, draw

STYLE = """body{font:14px/1.45 Georgia,serif;max-width:820px;margin:28px auto;padding:0 18px;color:#222}
h1{font-size:21px;margin:0 0 2px}h2{font-size:15px;margin:20px 0 5px;border-bottom:1px solid #ddd}
p{margin:5px 0}table{border-collapse:collapse;font:12.5px/1.4 system-ui,sans-serif;margin:6px 0}
td,th{padding:2px 12px 2px 0;text-align:left;vertical-align:top;border-bottom:1px solid #eee}th{font-weight:600}
.n{text-align:right;font-variant-numeric:tabular-nums}
.lead{font-size:16px;margin:8px 0 4px}.small{color:#666;font-size:12px}
img{width:100%}"""

HEAD = {
    "adequate": "Nothing is missing that this data could show.",
    "recalibration": "The model's own numbers were off; no effect is missing beyond that.",
    "effects": "The model lacks physics, and the missing effects have names.",
    "unknown": "Something is missing that the registry of effects cannot name.",
}


def write_report(verdict: Verdict, curves: list[Curve]) -> str:
    """The page as HTML, pictures inside."""
    parts = [
        f"<!doctype html><html lang='en'><meta charset='utf-8'><title>Gap: {escape(verdict.set)}</title>",
        f"<style>{STYLE}</style><h1>Simulation against measurement: {escape(verdict.set)}</h1>",
        f"<p class='small'>system {verdict.system} &middot; test level {verdict.alpha:g} &middot; "
        f"noise floor from {'repeats' if verdict.floor_source == 'repeats' else 'the residual'} &middot; "
        f"{verdict.seconds:.0f} s</p>",
        f"<p class='lead'><b>{HEAD[verdict.verdict]}</b> {_summary(verdict)}</p>",
    ]
    if curves:
        parts.append(f"<img alt='measured and simulated; residual with the places found' src='{draw(curves)}'>")
    parts += ["<h2>Where</h2>", _where(verdict), "<h2>What, and how sure</h2>", _what(verdict)]
    parts += ["<h2>Before and after, on episodes kept apart</h2>", _gap_table(verdict.gap)]
    if verdict.forward is not None:
        f = verdict.forward
        parts.append(
            f"<p>Run forward from the measured state in windows of 0.3 s, the position error goes from "
            f"{f.before:.3g} to {f.after:.3g} {f.unit}.</p>"
        )
    if verdict.placebos:
        rows = "; ".join(f"{_words(p.what)}: gap &times; {p.ratio:.3f}" for p in verdict.placebos)
        parts.append(f"<p>Controls that must not help: {rows}.</p>")
    parts += ["<h2>What to measure next</h2>", _next(verdict)]
    if verdict.notes:
        parts.append("<p class='small'>" + " ".join(escape(n) for n in verdict.notes) + "</p>")
    return "\n".join(parts)


def _words(text: str) -> str:
    """A sentence with the registry's names as words, for HTML; names of joints and files stay as they are."""
    from ...sim.effects.body.body_registry import BODY_EFFECTS
    from ...sim.effects.cloth.cloth_registry import CLOTH_EFFECTS
    from ...sim.effects.joint.joint_registry import JOINT_EFFECTS

    names = sorted({*BODY_EFFECTS, *CLOTH_EFFECTS, *JOINT_EFFECTS}, key=len, reverse=True)
    return re.sub(rf"\b({'|'.join(names)})\b", lambda m: m[0].replace("_", " "), escape(text))


def _percent(x: float) -> str:
    return f"{100 * x:.0f} %" if x == x else "&ndash;"


def _summary(v: Verdict) -> str:
    named = ", ".join(f"{f.name.replace('_', ' ')} ({escape(f.target)})" for f in v.effects[:6])
    more = f" and {len(v.effects) - 6} more" if len(v.effects) > 6 else ""
    change = (
        f"The held-out gap goes from {v.gap.before:.3g} to {v.gap.after:.3g} {v.gap.unit}, "
        f"noise floor {v.gap.floor:.3g}."
    )
    if v.verdict == "adequate":
        return f"The held-out residual is {v.gap.before:.3g} {v.gap.unit}, p = {v.p_value:.2g} after correction."
    if v.verdict == "unknown":
        return f"Best guess: {escape(v.guess) or 'none'}."
    return (f"{named}{more}. " if named else "") + change


def _where(v: Verdict) -> str:
    if not v.where:
        return "<p>No place stands out.</p>"
    groups: dict[tuple[str, str, str], list] = {}
    for w in v.where:
        groups.setdefault((w.channel, w.effect, w.target), []).append(w)
    rows = []
    for (channel, effect, target), places in list(groups.items())[:14]:
        first = places[0]
        times = ", ".join(f"{w.t0:.2f}&ndash;{w.t1:.2f}" for w in places if w.episode == first.episode)
        count = len([w for w in places if w.episode == first.episode])
        if count > 5:
            times = ", ".join(times.split(", ")[:4]) + f" and {count - 4} more"
        p = "&lt; 1e-12" if first.p_value < 1e-12 else f"{first.p_value:.1g}"
        rows.append(
            f"<tr><td>{escape(channel)}</td><td>{escape(target)}</td><td>{escape(effect.replace('_', ' ')) or '?'}</td>"
            f"<td>{escape(first.episode)}: {times} s</td><td>{escape(first.state_region)}</td>"
            f"<td>{escape(first.phase) or '&ndash;'}</td><td class=n>{first.size:.1f}</td><td class=n>{p}</td></tr>"
        )
    return (
        "<table><tr><th>channel<th>acts on<th>because of<th>when<th>state<th>phase<th class=n>size / floor"
        "<th class=n>p, corrected</tr>" + "".join(rows) + "</table>"
    )


def _what(v: Verdict) -> str:
    out = []
    if v.recalibration:
        out.append("<p>Refitted first, the model's own parameters:</p>")
        out.append(_effects(v.recalibration, "change of " if v.system in ("arm", "axis") else ""))
    if v.effects:
        out.append(_effects(v.effects))
    if v.changes:
        each = "; ".join(
            f"at {c.t:.2f} s of {escape(c.episode)} from {c.before:.3g} to {c.after:.3g} kg" for c in v.changes
        )
        out.append(f"<p>The payload changes {each}.</p>")
    if v.rivals:
        sets = "; ".join(_words(" + ".join(n for n, _ in r.effects)) for r in v.rivals)
        out.append(f"<p>This data is explained as well by: {sets}.  The set above is the likelier one.</p>")
    added = [f"{f.name.replace('_', ' ')} on {escape(f.target)}" for f in v.effects]
    added += [f"{f.name.replace('_', ' ')} of {escape(f.target)} changed" for f in v.recalibration]
    if added:
        out.append(f"<p>Added to the model in <code>model.yaml</code>: {', '.join(added)}.</p>")
    if v.verdict == "unknown":
        out.append(f"<p>Symbolic guess for what is left: {escape(v.guess) or 'none'}.</p>")
    return "".join(out) or "<p>No effect in the registry explains more than noise would.</p>"


def _effects(findings: tuple[EffectFinding, ...], prefix: str = "") -> str:
    rows = []
    for f in findings:
        values = "<br>".join(
            f"{prefix}{escape(x.name.replace('_', ' '))} {x.value:.4g} {escape(x.unit) if x.unit != '1' else ''}"
            + (f" ({x.low:.4g} to {x.high:.4g})" if x.low != x.high else "")
            + (f"; {escape(x.doubt)}" if x.doubt else "")
            for x in f.parameters
        )
        others = _words(", ".join(f.equivalent)) or "&ndash;"
        rows.append(
            f"<tr><td>{escape(f.name.replace('_', ' '))}</td><td>{escape(f.target)}</td><td>{values}</td>"
            f"<td class=n>{f.size:.1f}</td><td class=n>{_percent(f.confidence)}</td><td>{others}</td></tr>"
        )
    return (
        "<table><tr><th>effect<th>on<th>value (95 % interval)<th class=n>size / floor<th class=n>kept in resamples"
        "<th>cannot be told from</tr>" + "".join(rows) + "</table>"
    )


def _gap_table(gap: Gap) -> str:
    rows = "".join(
        f"<tr><td>{escape(n)}</td><td class=n>{c['floor']:.3g}</td><td class=n>{c['before']:.3g}</td>"
        f"<td class=n>{c['after']:.3g}</td><td class=n>{c['after'] / max(c['before'], 1e-12):.3f}</td></tr>"
        for n, c in list(gap.channels.items())[:16]
    )
    closed = (
        f"{100 * gap.closed:.0f} % of the gap above the floor is gone"
        if gap.closed == gap.closed
        else "there was no gap"
    )
    rows += (
        f"<tr><th>all</th><td class=n>{gap.floor:.3g}</td><td class=n>{gap.before:.3g}</td><td class=n>{gap.after:.3g}"
        f"</td><td class=n>{gap.after / max(gap.before, 1e-12):.3f}</td></tr>"
    )
    return (
        f"<table><tr><th>channel<th class=n>floor [{gap.unit}]<th class=n>before<th class=n>after<th class=n>ratio</tr>"
        f"{rows}</table><p>{closed}; ratio between {gap.low:.3f} and {gap.high:.3f} (95 %).</p>"
    )


def _asked(v: Verdict) -> str:
    """The recordings asked for, as a sentence."""
    what = "; ".join(escape(f.sentence) for f in v.follow_up)
    apart = v.follow_up[0].apart
    why = f" (the nearest set that fits as well is then {apart:.2g} standard deviations away)" if apart else ""
    return f"{what[0].upper()}{what[1:]}{why}.  Add these recordings to the set and run this again."


def _next(v: Verdict) -> str:
    wanted = [f.experiment for f in (*v.effects, *v.recalibration)] + [r.experiment for r in v.rivals]
    items = [f"<li>{_words(x)}</li>" for x in dict.fromkeys(wanted) if x]
    if v.follow_up:
        items.insert(0, f"<li>{_asked(v)}</li>")
    small = [
        f"<li>{escape(f.name.replace('_', ' '))} on {escape(f.target)} would have been seen down to "
        f"{100 * f.smallest:.0f} % of the size found</li>"
        for f in v.effects
        if f.smallest == f.smallest and f.smallest < 4
    ]
    hidden = [
        f"<li>{escape(k.replace('_', ' '))}: {escape(x)} could hide in this data unseen</li>"
        for k, x in list(v.detectable.items())[:6]
    ]
    return "<ul>" + "".join(items[:6] + small[:4] + hidden) + "</ul>" if items or small or hidden else "<p>Nothing.</p>"
