"""A clock that is wrong, for one process: a small library that the system puts before its own."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

SOURCE = r"""
#define _GNU_SOURCE
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static long shift(void) { const char *said = getenv("VIPO_CLOCK_SHIFT_S"); return said ? atol(said) : 0; }

int clock_gettime(clockid_t which, struct timespec *at) {
    int failed = syscall(SYS_clock_gettime, which, at);
    if (!failed && (which == CLOCK_REALTIME || which == CLOCK_REALTIME_COARSE)) at->tv_sec += shift();
    return failed;
}

int gettimeofday(struct timeval *at, void *zone) {
    struct timespec now;
    int failed = clock_gettime(CLOCK_REALTIME, &now);
    (void)zone;
    if (!failed && at) { at->tv_sec = now.tv_sec; at->tv_usec = now.tv_nsec / 1000; }
    return failed;
}

time_t time(time_t *at) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (at) *at = now.tv_sec;
    return now.tv_sec;
}
"""


def can_shift() -> bool:
    """Tell whether this machine has the C compiler that it takes."""
    return shutil.which("cc") is not None


def shifted(folder: Path, seconds: int) -> dict[str, str]:
    """Return what a process is told whose clock shall be so far ahead; nothing where there is no C compiler."""
    library = folder / "clock.so"
    if not library.exists():
        if not can_shift():
            return {}
        source = folder / "clock.c"
        source.write_text(SOURCE)
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", str(library), str(source)], check=True)
    return {"LD_PRELOAD": str(library), "VIPO_CLOCK_SHIFT_S": str(seconds)}
