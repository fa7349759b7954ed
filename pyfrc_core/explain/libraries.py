"""Errors that WPILib, magicbot, commands2 and vendors' libraries raise: one row for each in `ROWS`.

The rows are matched with type and text of the error. Their placeholders are the groups of the pattern, `cls` (the
user's class that the library was working with) and `since` (where a device was created before, if the error knows).
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from traceback import walk_tb

from ..errors import nearest, text_of
from ..project.robot_files import RobotFiles
from ..season import CURRENT
from .explanation import Explanation
from .other_season import in_2027
from .places import (
    calls_at,
    class_named,
    frames_of,
    is_in_opmode,
    last_name,
    line_of_class,
    robot_trees,
    users_class,
    users_frame,
    value_of,
)

_STACK_LINE = re.compile(r'File "([^"]+)", line (\d+)')
#: In that stack, the line of the first function, and the name of the second.
_CALLED_IN_STACK = re.compile(
    r'File "[^"]+", line \d+, in .*\n\s+(?P<line>.*)\n\s+File "[^"]+", line \d+, in (?P<name>\w+)'
)
_FILE_AND_LINE = re.compile(r"(?P<file>.+\.py):(?P<line>\d+)")

_OWN_CHANNEL = "Each device needs a channel of its own: change one of the two to the number that it is wired to."
#: Instead, if it was this line that made the device before.
_MADE_AGAIN = (
    "This line runs more than once, and makes the device each time. Make it once, in the __init__ of the robot, and "
    "use it here."
)
#: Instead, if another line makes the same attribute.
_MADE_TWICE = "Both lines make {}. Make it once, in the __init__ of the robot, and remove both lines."
#: Instead, if it was another opmode that made it.
_MADE_BY_TWO = (
    "Two opmodes make it. If it is one device, make it once, in the __init__ of the robot, and use it in both; else "
    "change one of the two to the number that it is wired to."
)
_FIRST_STATE = "Write @state(first=True) above the state with which it begins, and @state above the others."


@dataclass(frozen=True)
class KnownError:
    """One error.

    :param pattern: matches the beginning of the error's type and text
    :param text: what is wrong; empty: as the library says it
    :param at: the name whose declaration in the user's class is the line to show; a placeholder
    :param in_robot: whether that class is the robot's, and not the component's
    """

    pattern: str
    text: str
    remedy: str
    at: str = ""
    in_robot: bool = False


ROWS = (
    # -- WPILib's devices. In its numbers, DIO channels are 0 to 30, and PWM channels follow from 31 on.
    KnownError(
        r"RuntimeError: PWM or DIO (?:\d|[12]\d|30) previously allocated.*: (?:Channel|Port) (?P<channel>-?\d+)",
        "DIO channel {channel} is used already{since}",
        f"{_OWN_CHANNEL} An encoder has two channels.",
    ),
    KnownError(
        r"RuntimeError: PWM or DIO \d+ previously allocated.*: (?:Channel|Port) (?P<channel>-?\d+)",
        "PWM channel {channel} is used already{since}",
        _OWN_CHANNEL,
    ),
    KnownError(
        r"RuntimeError: (?P<kind>Analog Input|Analog Output|Relay) (?P<channel>\d+) previously allocated",
        "{kind} {channel} is used already{since}",
        _OWN_CHANNEL,
    ),
    KnownError(  # as WPILib 2027 says it
        r"RuntimeError: (?P<kind>PWM|DIO|Analog|AddressableLED|Duty Cycle) \d+ previously allocated.*"
        r": Channel (?P<channel>-?\d+)",
        "{kind} channel {channel} is used already{since}",
        _OWN_CHANNEL,
    ),
    KnownError(
        r"RuntimeError: Attempted to reuse an allocated resource: Channel (?P<channel>\d+)",
        "channel {channel} of this pneumatics module has a solenoid already",
        f"{_OWN_CHANNEL} A DoubleSolenoid has two channels.",
    ),
    KnownError(
        r"RuntimeError: Attempted to reuse an allocated resource: (?P<module>\d+)$",
        "the pneumatics module {module} has a Compressor object already",
        "Create it once, and pass it to the code that needs it.",
    ),
    KnownError(
        r"RuntimeError: Allocating channel that is out of range: \w+ (?P<channel>-?\d+)",
        "there is no channel {channel} for such a device",
        CURRENT.controller.channels,
    ),
    KnownError(  # of WPILib 2027, where the maximum is a channel
        ("" if CURRENT.year >= 2027 else "(?!)")
        + r"RuntimeError: Invalid Index for (?P<kind>[\w ]+?)\s*Status.*Minimum: (?P<low>\d+) Maximum: (?P<end>\d+) "
        r"Requested: (?P<channel>-?\d+): Channel",
        "there is no channel {channel} for {kind}: they are {low} to {end}",
        "Change it to the number of the channel that it is wired to.",
    ),
    KnownError(
        r"RuntimeError: Invalid Index for (?P<kind>[\w ]+?)\s*Status.*Minimum: (?P<low>\d+) Maximum: (?P<end>\d+) "
        r"Requested: (?P<channel>-?\d+)",
        "there is no channel {channel} for {kind}: it must be {low} or more, and less than {end}",
        "Change it to the number of the channel that it is wired to.",
    ),
    KnownError(
        r"RuntimeError: HAL: No available resources to allocate",
        f"the {CURRENT.controller.name} has no more devices of this kind",
        f"It has {CURRENT.controller.few}: create each once, and not in a method that is called again.",
    ),
    KnownError(
        r"RuntimeError: A (?P<kind>\w+) instance has already been created with this device ID: (?P<id>\d+)",
        "CAN ID {id} is used already, by another {kind}",
        "Each motor controller needs a CAN ID of its own, set with REV Hardware Client; create one object for each.",
    ),
    KnownError(
        r"RuntimeError: Joystick index is out of range, should be 0-5: port (?P<port>-?\d+)",
        "there is no joystick {port}: they are 0 to 5",
        "Write its number in the USB devices of the Driver Station; the first is 0.",
    ),
    # -- magicbot
    KnownError(
        r"ValueError: Component (?P<name>\w+) \(.*\) must have a method named 'execute'",
        "class {cls} has no execute()",
        "magicbot calls it in each loop: add def execute(self): to the class, with pass if there is nothing to do.",
    ),
    KnownError(
        r"AttributeError: '(?P<name>\w+)' object has no attribute 'watchdog'",
        "class {cls} has a robotInit(), which replaces that of MagicRobot",
        "Rename it to createObjects: there, a MagicRobot makes its devices.",
        at="robotInit",
        in_robot=True,
    ),
    KnownError(
        r"MagicInjectError: (?:Component|Autonomous mode) .+? has variable (?P<name>\w+) "
        r"\(type <class '(?P<type>(?!wpi|rev|phoenix|navx|ntcore|commands2)\w+\.[^']+)'>\), which is absent",
        "class {cls} asks for {name}, which the robot does not declare",
        "Write {name}: {type} among the components of the robot's class.",
        at="{name}",
    ),
    KnownError(
        r"MagicInjectError: (?P<kind>Component|Autonomous mode) (?P<component>.+?) has variable (?P<name>\w+) "
        r"\(type <class '(?P<type>[^']+)'>\), which is absent",
        "class {cls} asks for {name}, which the robot does not have",
        "Is the name right? If it is, create self.{name} or self.{component}_{name} in createObjects() of the robot.",
        at="{name}",
    ),
    KnownError(
        r"MagicInjectError: Component .+? variable (?P<name>\w+) does not match type in robot! \(Got <class 'type'>",
        "{name} is the class itself, and no component: it was written with = instead of :",
        "Declare a component with a colon: {name}: {expected}",
        at="{name}",
        in_robot=True,
    ),
    KnownError(
        r"MagicInjectError: Component .+? variable (?P<name>\w+) does not match type in robot! "
        r"\(Got <class '(?P<got>[^']+)'>, expected <class '(?P<type>[^']+)'>\)",
        "class {cls} asks for {name} as {type}, but the robot has {got} under this name",
        "Change the type here, or what createObjects() of the robot creates.",
        at="{name}",
    ),
    KnownError(
        r"TypeError: (?P<robot>\w+) has a non-type annotation on (?P<name>\w+) \((?P<value>.*?)\)",
        "{name}: {value} declares a value as a type",
        "Write {name} = {value} for a value, or {name}: SomeClass for a component.",
        at="{name}",
        in_robot=True,
    ),
    KnownError(r"NoFirstStateError", "class {cls} has no first state", _FIRST_STATE),
    KnownError(r"ValueError: Starting state not defined", "class {cls} has no first state", _FIRST_STATE),
    KnownError(
        r"(MultipleFirstStatesError|ValueError: Multiple states were specified)",
        "class {cls} has more than one first state",
        "Write first=True for one of its states only.",
    ),
    KnownError(
        r"MultipleDefaultStatesError",
        "class {cls} has more than one default state",
        "Write @default_state above one of its methods only.",
    ),
    KnownError(
        r"IllegalCallError",
        "a state is called like a method",
        'Write self.next_state("NAME") inside the state machine, and engage() outside of it.',
    ),
    KnownError(
        r"InvalidStateName: cannot have a state named '(?P<name>\w+)'",
        "a state cannot be called {name}: StateMachine has a method of that name",
        "Give the state another name.",
    ),
    KnownError(
        r"ValueError: Invalid parameter names in (?P<name>\w+): (?P<wrong>.+)",
        "the state {name} has a parameter that magicbot does not know: {wrong}",
        "A state may have the parameters self, tm, state_tm and initial_call.",
    ),
    KnownError(
        r"(ValueError: timed_state functions must specify|TypeError: timed_state\(\) missing .*'duration')",
        "a timed_state without a duration",
        "Write @timed_state(duration=2), in seconds.",
    ),
    KnownError(
        r"ValueError: super\(\).__init__\(components\) was never called",
        "class {cls} does not call super().__init__(components)",
        "Make that the first line of its __init__.",
    ),
    KnownError(
        r"ValueError: Must define MODE_NAME",
        "class {cls} has no MODE_NAME",
        'Write MODE_NAME = "Two balls" in the class.',
    ),
    KnownError(
        r"TypeError: .*'(?P<kind>tunable|will_reset_to)'",
        "a {kind} works only in the body of a class, and this one is made in a method",
        "Write name = {kind}(0.5) above the methods of the class, and self.name in them.",
    ),
    # -- commands2
    KnownError(
        r"IllegalCommandUse: Multiple commands in a parallel composition cannot require.*\(common=\{<(?P<type>[\w.]+)",
        "two commands that run at the same time both need {type}",
        "A subsystem does one command at a time. Run them one after the other, with one.andThen(other) or "
        "commands2.cmd.sequence(one, other), or remove one.",
    ),
    KnownError(
        r"IllegalCommandUse: Default commands must require their subsystem.*subsystem=<(?P<type>[\w.]+)",
        "the default command of {type} does not require it",
        "Pass the subsystem to the command, as in commands2.RunCommand(function, subsystem); or write "
        "self.addRequirements(subsystem) in the command's __init__.",
    ),
    KnownError(
        r"IllegalCommandUse: Commands that have been composed may not.*originally composed at (?P<place>.+?\.py:\d+)\)",
        "this command is already part of another one, composed at {place}",
        "Use a command object once: create a second one for the second use, for example with a function that returns "
        "a new command each time.",
    ),
    KnownError(
        r"IllegalCommandUse: Cannot compose a command twice",
        "the same command object is twice in this composition",
        "Create a command object for each use, for example with a function that returns a new one.",
    ),
    KnownError(
        r"IllegalCommandUse: Commands that have been scheduled individually",
        "this command is running by itself, and cannot become part of another one",
        "Create another command object for the composition.",
    ),
    KnownError(
        r"IllegalCommandUse: Commands cannot be added to a composition while it is running",
        "",
        "Add all commands when you create the composition.",
    ),
    KnownError(
        r"IllegalCommandUse: The deadline command cannot also be",
        "the deadline is also among the other commands",
        "Name it once: deadline.deadlineFor(other, another).",
    ),
    KnownError(
        r"TypeError: [\w.]+__init__\(\) must be called when overriding __init__",
        "class {cls} does not call super().__init__()",
        "Make that the first line of its __init__.",
    ),
    # -- Python
    KnownError(
        r"TypeError: can only concatenate str",
        "",
        'Write the value into the text, as in: f"speed: {{value}}"',
    ),
    KnownError(
        r"TypeError: descriptor '__init__' of 'super' object needs an argument",
        "super is a function, and is not called here",
        "Write super().__init__()",
    ),
    KnownError(
        r"TypeError: can't multiply sequence by non-int",
        "a text or a list is multiplied, and no number",
        "Write the number without quotes; or float(text) if it comes from elsewhere.",
    ),
    KnownError(
        r"TypeError: cannot unpack non-iterable", "", "The right side is one value: write one name before the =."
    ),
    KnownError(r"TypeError: 'int' object is not iterable", "", "To count, write range, as in: for number in range(5):"),
    KnownError(r"IndexError: list index out of range", "", "Indexes begin with 0: the last one is the length - 1."),
    KnownError(
        r"IndexError: string index out of range",
        "",
        "The text is empty or shorter: ask for its length first. Game data are empty until the field sends them.",
    ),
    KnownError(
        r"TypeError: (?:\w+\.)*(?P<name>\w+): No constructor defined",
        "no object of {name} can be created",
        "Call its functions on the class, as in: wpilib.SmartDashboard.putNumber(name, value)",
    ),
    KnownError(
        r"TypeError: '(?P<type>\w+)' object is not callable",
        "",
        "The name before () is a {type}, and no function. Was it to be passed as a function: lambda: ...?",
    ),
    KnownError(
        r"(TypeError|AttributeError): .*'NoneType'",
        "",
        "A value is None: a function without return gives None, and so does a name that is set later.",
    ),
    KnownError(r"exit\(", "", "A robot program must not end by itself: remove that line."),
    KnownError(r"RecursionError", "a function calls itself without end", "Did you mean super()., or another method?"),
)


def explain(error: BaseException, files: RobotFiles) -> Explanation | None:
    text = text_of(error)
    if isinstance(error, KeyError) and (explained := _unknown_state(error)):
        return explained
    for row in ROWS:
        found = re.match(row.pattern, text, re.DOTALL)
        if found is not None:
            return _explained(row, found, error, files)
    return None


def _unknown_state(error: KeyError) -> Explanation | None:
    """Explain a next_state() of magicbot that names no state."""
    frame = frames_of(error)[-1]
    if not frame.f_globals.get("__name__", "").startswith("magicbot.state_machine") or not error.args:
        return None
    machine = frame.f_locals.get("self")
    known = [each for each in dir(machine) if not each.startswith("_") and each not in dir(type(machine).__base__)]
    text = f"class {type(machine).__name__} has no state {error.args[0]}"
    hint = nearest(str(error.args[0]), known)
    return Explanation(text, hint[0].upper() + hint[1:])


def _explained(row: KnownError, found: re.Match[str], error: BaseException, files: RobotFiles) -> Explanation:
    words = {name: value or "" for name, value in found.groupdict().items()}
    named = re.search(r"<([\w.]+) object at ", found[0])
    cls = class_named(named[1], files) if named else None
    if row.in_robot:
        owners = (type(frame.f_locals.get("self")) for frame in reversed(frames_of(error)))
        cls = next((each for each in owners if line_of_class(each, files)), None)
        words["expected"] = getattr(vars(cls).get(words["name"]), "__name__", "TheClass") if cls else "TheClass"
    cls = cls or users_class(error, files, words.get("type", ""))
    words["cls"] = cls.__name__ if cls is not None else words.get("name", "")
    here = files.innermost_line(error.__traceback__, tests=False)
    first = next(reversed(_first_stack(str(error), files)), None)
    before = f"{files.relative(first[0])}:{first[1]}" if first is not None else ""
    words["since"] = f", since {before}" if before else ""
    for name in ("type", "got"):
        words[name] = words.get(name, "").replace("._wpilib.", ".").rpartition(".")[2]
    if place := _FILE_AND_LINE.fullmatch(words.get("place", "")):
        words["place"] = f"{files.relative(place['file'])}:{place['line']}"
    line = line_of_class(cls, files, row.at.format_map(words)) if cls is not None and here is None else ""
    remedy = in_2027(row.remedy).format_map(words)
    outer = next(iter(_first_stack(str(error), files)), ("", 0))
    now = {(frame.f_code.co_filename, line) for frame, line in walk_tb(error.__traceback__)}
    if before and outer[0] and not files.is_robot_code(outer[0]) and outer not in now and _is_called_by(str(error)):
        words["since"] = f": {files.relative(outer[0])}:{outer[1]} in the test has made it before the run does"
        remedy = "Remove that line: control.run_test(...) calls robotInit and the other methods itself."
    elif before and before == here:
        again = _made_by(error, files) or Explanation(words["since"], _MADE_AGAIN, line)
        words["since"], remedy, line = again.text, again.remedy, again.place
    elif here is not None and (made := _attribute_at(before, files)) and made == _attribute_at(here, files):
        remedy = _MADE_TWICE.format(made[1])
    elif first is not None and is_in_opmode(*first) and (where := users_frame(error, files)) is not None:
        remedy = _MADE_BY_TWO if is_in_opmode(where[0].f_code.co_filename, where[1]) else remedy
    else:
        remedy += _set_elsewhere(words.get("channel", words.get("id", "")), error, files)
    return Explanation(in_2027(row.text).format_map(words), remedy, line)


def _is_called_by(text: str) -> bool:
    """Return whether the outermost line of WPILib's stack makes the device, or calls what does, without the run."""
    called = _CALLED_IN_STACK.search(text)
    return called is None or called["name"] == "__init__" or called["name"] in called["line"]


def _attribute_at(place: str, files: RobotFiles) -> tuple[str, str] | None:
    """Return the class and the attribute that is assigned at a place, such as ``Robot`` and ``self.arm``."""
    for file, tree in robot_trees(files):
        for cls in (each for each in ast.walk(tree) if isinstance(each, ast.ClassDef)):
            for node in ast.walk(cls):
                if isinstance(node, ast.Assign) and f"{file}:{node.lineno}" == place:
                    target = node.targets[0]
                    return (cls.name, ast.unparse(target)) if isinstance(target, ast.Attribute) else None
    return None


def _set_elsewhere(number: str, error: BaseException, files: RobotFiles) -> str:
    """Return where a number that the user's line passes by a name is set, as a sentence; empty: it passes none so."""
    where = users_frame(error, files)
    for call in calls_at(*where, "") if where is not None else ():
        for each in (*call.args, *(keyword.value for keyword in call.keywords)):
            if where is None or isinstance(each, ast.Constant) or str(value_of(each, where[0])) != number:
                continue
            for file, tree in robot_trees(files):
                for node in ast.walk(tree):
                    if not isinstance(node, ast.Assign) or not isinstance(node.value, ast.Constant):
                        continue
                    if last_name(node.targets[0]) == last_name(each) and str(node.value.value) == number:
                        return f" {ast.unparse(each)} is set in {file}:{node.lineno}."
    return ""


def _first_stack(text: str, files: RobotFiles) -> list[tuple[str, int]]:
    """Return the project's files and lines in the stack that WPILib adds to its message, outermost first."""
    return [(file, int(line)) for file, line in _STACK_LINE.findall(text) if files.is_project_file(file)]


def _made_by(error: BaseException, files: RobotFiles) -> Explanation | None:
    """Explain two objects of a class whose __init__ makes a device: where the first and the second are made."""
    now = [each for each in walk_tb(error.__traceback__) if files.is_project_file(each[0].f_code.co_filename)]
    inner = now[-1][0]
    for (file, at), (frame, line) in zip(reversed(_first_stack(str(error), files)), reversed(now), strict=False):
        place = f"{files.relative(frame.f_code.co_filename)}:{line}"
        if place != (first := f"{files.relative(file)}:{at}"):
            text = f": this makes a second {type(inner.f_locals.get('self')).__name__}, and {first} the first"
            remedy = "Use the first here, too: pass it on. If it must be another one, it needs channels of its own."
            return Explanation(text, remedy, place) if inner.f_code.co_name == "__init__" else None
        inner = frame
    return None
