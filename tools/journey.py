"""How much of the package one job goes through: its files, its functions, its lines.

    python -m tools.journey        prints the figures and writes docs/results/plain.json

A job begins with `md.load` and ends with the motion that it returns; a recipe is trained for a few
steps. What is counted is what it executes of `motiondiff_edu`: files, functions, and lines, each
once, however often they run. Imports do not count, and the weights were loaded before. The same is
counted for generation alone (`GENERATION`), with the share of its lines that lie in the syllabus;
and the functions that the notebooks explain (`TAUGHT`) are looked for in what was executed.
"""

import importlib
import inspect
import json
import os
import pkgutil
import re
import sys
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import CodeType, FrameType

import soundfile

import motiondiff_edu as md
from benchmarks.records import write_records
from data_synth.music import compose
from data_synth.walking import walk as synthetic_walk
from motiondiff_edu.conditions.control import constant_control
from motiondiff_edu.pretrained.checkpoints import save
from motiondiff_edu.recipes import dancer, walker

ROOT = Path(__file__).parent.parent
PACKAGE = Path(md.__file__).parent
TARGET = ROOT / "docs" / "results" / "plain.json"
COMMAND = "python -m tools.journey"

# what generates, in the job of each verb
GENERATION = {"walk": "rollout.rollout_steps", "dance": "performers.dancer.Dancer.dance_mel"}

# what the notebooks explain, and the jobs that must execute it; a name that is gone is missed, too
TAUGHT = {
    "modiff.MoDiff.encode": ("walk", "recipe"),
    "modiff.MoDiff.decode": ("walk", "recipe"),
    "mofusion.MoFusion.encode": ("dance", "dancer_recipe"),
    "mofusion.MoFusion.decode": ("dance", "dancer_recipe"),
    "rollout.rollout_steps": ("walk",),
    "ddpm.ddim_steps": ("walk", "dance"),
    "ddpm.ddim_step": ("walk", "dance"),
    "modiff.training_loss": ("recipe",),
    "kinematic_loss.training_loss": ("dancer_recipe",),
}


# ---- tracing -------------------------------------------------------------------------------------
@dataclass
class Journey:
    """What a job has executed of a package: code objects, and (file, line) pairs.

    `within` has the pairs that ran inside of `part`, a code object.
    """

    package: Path
    part: CodeType | None = None
    called: set[CodeType] = field(default_factory=set)
    lines: set[tuple[str, int]] = field(default_factory=set)
    within: set[tuple[str, int]] = field(default_factory=set)
    depth: int = 0  # of `part`

    def __post_init__(self):
        self.prefix = f"{self.package}{os.sep}"

    @property
    def files(self) -> set[str]:
        return {file for file, _ in self.lines}

    @property
    def functions(self) -> set[CodeType]:
        """Functions and methods; a lambda is one, a comprehension is none."""
        return {code for code in self.called if not re.fullmatch(r"<\w+(comp|expr)>", code.co_name)}

    def entered(self, frame: FrameType, event: str, value: object) -> Callable | None:
        """What `sys.settrace` calls for each new frame; only own code is followed by the line."""
        code = frame.f_code
        runs = code.co_flags & inspect.CO_OPTIMIZED  # not the body of a module or a class
        if not runs or not code.co_filename.startswith(self.prefix):
            return None
        self.called.add(code)
        self.depth += code is self.part
        return self.followed

    def followed(self, frame: FrameType, event: str, value: object) -> Callable:
        """What is called for each line of own code, and where a frame is left."""
        if event == "line":
            place = (frame.f_code.co_filename, frame.f_lineno)
            self.lines.add(place)
            if self.depth:
                self.within.add(place)
        self.depth -= event == "return" and frame.f_code is self.part
        return self.followed


def traced(job: Callable[[], object], package: Path, part: CodeType | None = None) -> Journey:
    """What `job` executes of the Python files in the folder `package`."""
    journey, before = Journey(package, part), sys.gettrace()
    sys.settrace(journey.entered)
    try:
        job()
    finally:
        sys.settrace(before)
    return journey


def code_of(name: str, package: str = md.__name__) -> CodeType | None:
    """The code of a function or method, "modiff.MoDiff.encode"; None if there is none."""
    parts = [package, *name.split(".")]
    for count in range(len(parts) - 1, 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:count]))
            for part in parts[count:]:
                found = getattr(found, part)
        except (ImportError, AttributeError):
            continue
        return getattr(inspect.unwrap(found), "__code__", None)
    return None


def syllabus(package: Path) -> set[str]:
    """The files directly in a package, but for `__init__`, `__main__` and other `_` ones."""
    return {str(path) for path in package.glob("*.py") if not path.name.startswith("_")}


def syllabus_share(journey: Journey) -> float:
    """The share of the lines of generation that lie in the syllabus."""
    files = syllabus(journey.package)
    inside = [file in files for file, _ in journey.within]
    return sum(inside) / max(1, len(inside))


# ---- the jobs ------------------------------------------------------------------------------------
def jobs(folder: Path) -> dict[str, Callable[[], object]]:
    """{name: the job}; what they need is made here, and `folder` holds their files."""
    given = md.Motion.of_clip(synthetic_walk(constant_control(1.0, seconds=3.0), seed=5))
    song = folder / "song.wav"
    soundfile.write(song, compose(3, "pop", seconds=4.0).audio, 16_000)
    short = {"steps": 3, "batch": 2, "seconds": 8.0}
    of_walker = replace(walker.RECIPES["walker"], clips=2, begins_with="", **short)
    of_dancer = replace(dancer.DANCE_RECIPES["dancer"], songs=2, dances=1, frames=40, **short)
    if ear := getattr(of_dancer, "ear", None):  # it is trained first
        of_dancer = replace(of_dancer, ear=replace(ear, songs=2, frames=(40, 60), **short))
    files = folder / "walker.safetensors", folder / "dancer.safetensors"
    return {
        "walk": lambda: md.load("walker").walk(given, md.joystick([(1, 1.2, 0, 0)]), seed=0),
        "dance": lambda: md.load("dancer").dance(song, seconds=4, seed=0),
        "inbetween": lambda: md.inbetween(given, md.keyframes(given, every=20)),
        "recipe": lambda: save(walker.train(of_walker, folder / "run", log=str), files[0]),
        "dancer_recipe": lambda: dancer.train_dancer(of_dancer, files[1], log=str),
    }


def warmed() -> None:
    """Import all of the package and load the weights, so that no job is the first to do so."""
    for module in pkgutil.walk_packages([str(PACKAGE)], f"{md.__name__}."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    for name in dir(md):  # `md` imports what it shows when it is first asked for
        getattr(md, name)
    for name in ("walker", "dancer", "inbetweener"):
        md.load(name)


def journeys() -> dict[str, Journey]:
    """{job: what it executed}."""
    warmed()
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, job in jobs(Path(folder)).items():
            print(f"{name} ...", file=sys.stderr, flush=True)
            found[name] = traced(job, PACKAGE, code_of(GENERATION.get(name, "")))
    return found


def missed(found: dict[str, Journey]) -> list[str]:
    """The taught functions that a job does not execute, and the jobs."""
    return [
        f"{name} by {job}"
        for name, wanted in TAUGHT.items()
        for job in wanted
        if code_of(name) not in found[job].called
    ]


# ---- departures ----------------------------------------------------------------------------------
UNPROVEN = ("not measured yet", "no gain is shown")  # what a departure says of itself


def unproven(texts: dict[str, str], records: Iterable[dict]) -> dict[str, str]:
    """{name: why} of the departures without a proven gain; `texts` are their docstrings.

    One is unproven if it says "not measured yet" or "no gain is shown", or if it names groups of
    records (`sweep.x.*`) with differences to a rival (`..._minus_rival`), and the interval of each
    contains 0. Those that name other records are not counted.
    """
    apart = [one for one in records if "_minus_" in one["name"]]
    found = {}
    for name, text in texts.items():
        groups = re.findall(r"`([\w.-]+)\.\*`", text)
        named = [one for one in apart if any(one["name"].startswith(f"{g}.") for g in groups)]
        said = [words for words in UNPROVEN if words in " ".join(text.lower().split())]
        if said:
            found[name] = said[0]
        elif named and all(one["low"] <= 0 <= one["high"] for one in named):
            found[name] = f"each of {len(named)} differences has an interval that contains 0"
    return found


def departures() -> dict[str, str]:
    """{file of beyond/: its docstring}."""
    paths = sorted((PACKAGE / "beyond").glob("[a-z]*.py"))
    names = [f"{md.__name__}.beyond.{path.stem}" for path in paths]
    return {name.rpartition(".")[2]: importlib.import_module(name).__doc__ or "" for name in names}


def measured() -> list[dict]:
    """All records of docs/results."""
    paths = TARGET.parent.glob("*.json")
    return [one for path in paths for one in json.loads(path.read_text(encoding="utf-8"))]


# ---- the figures ---------------------------------------------------------------------------------
def record(name: str, value: float, unit: str) -> dict:
    """A record of something counted: its interval is the number."""
    return dict(
        name=f"plain.{name}",
        value=value,
        low=value,
        high=value,
        seeds={"seed": 0},
        unit=unit,
        paper=None,
        command=COMMAND,
    )


def records_of(found: dict[str, Journey]) -> list[dict]:
    made = []
    for name in ("walk", "dance", "inbetween", "recipe"):
        journey = found[name]
        made += [
            record(f"{name}_files", len(journey.files), "files"),
            record(f"{name}_functions", len(journey.functions), "functions"),
            record(f"{name}_lines", len(journey.lines), "executed lines"),
        ]
    for name in GENERATION:
        made.append(record(f"{name}_syllabus_share", syllabus_share(found[name]), "share"))
    made.append(record("taught_lines_hit", int(not missed(found)), "1 if all are executed"))
    made.append(record("unproven", len(unproven(departures(), measured())), "files"))
    return made


def main() -> None:
    found = journeys()
    made = records_of(found)
    for one in made:
        print(f"{one['name']:28s} {one['value']:8.4g} {one['unit']}")
    for words in missed(found):
        print(f"taught, and not executed: {words}")
    for name, why in unproven(departures(), measured()).items():
        print(f"unproven: beyond/{name}.py: {why}")
    write_records(TARGET, made)
    print(f"wrote {TARGET.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
