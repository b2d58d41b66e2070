"""What execution keeps: runs, commands, sites, rehearsals, tests of programs, archives, what the mirror measured."""

from execution.models.archives import Archivable, Archive, Keeping
from execution.models.commands import Command
from execution.models.mirror import Calibration, Measurement
from execution.models.program_tests import MeantChange, ProgramTest, TrialResult, TrialRun
from execution.models.rehearsals import Rehearsal
from execution.models.runs import ArmedProgram, Question, Run, RunEvent, RunInput, Timer
from execution.models.sites import DeadLetter, FloorState, InboxEvent, Lease, SiteLease, SiteStop, StopFollowed

__all__ = [
    "Archivable",
    "Archive",
    "ArmedProgram",
    "Calibration",
    "Command",
    "DeadLetter",
    "FloorState",
    "InboxEvent",
    "Keeping",
    "Lease",
    "MeantChange",
    "Measurement",
    "ProgramTest",
    "Question",
    "Rehearsal",
    "Run",
    "RunEvent",
    "RunInput",
    "SiteLease",
    "SiteStop",
    "StopFollowed",
    "Timer",
    "TrialResult",
    "TrialRun",
]
