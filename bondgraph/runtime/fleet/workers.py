"""Where the logs of a fleet are watched: here, in processes of this machine, or on Dask."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.connection import Connection
from threading import Thread
from typing import TYPE_CHECKING

from bondgraph.runtime.fleet.watched_log import WatchedLog
from bondgraph.runtime.fleet.watcher import Item, Watcher, watch_in_worker
from bondgraph.runtime.monitoring.watch_settings import WatchSettings
from bondgraph.runtime.threads import VARIABLES
from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from distributed import Client

#: What `watched` gives: which of the items it was, and what came of it.
Result = tuple[int, WatchedLog]

_PATIENCE = 10  # s in which a scheduler has to answer
_DIED = "the process that watched it died, perhaps for want of memory"


def watched(
    settings: WatchSettings, items: Sequence[Item], jobs: int = 1, client: Client | None = None
) -> Iterator[Result]:
    """The results of logs as they come, in any order.

    With one job they are watched in this process, one after the other; else in so many processes,
    or by the workers of a Dask `client`. A worker compiles the model by itself, once for each rate.
    """
    if client is not None:
        executor = client.get_executor()
        try:
            yield from _submitted(executor, pickle.dumps(settings), dict(enumerate(items)))
        finally:
            executor.shutdown(wait=False)  # what is not done is not wanted any more
    elif min(jobs, len(items)) <= 1:
        watcher = Watcher(settings)
        for k, item in enumerate(items):
            yield k, watcher.watch(item)
    else:
        yield from _in_processes(pickle.dumps(settings), items, jobs)


def _submitted(executor: Executor, settings: bytes, items: dict[int, Item]) -> Iterator[Result]:
    """What an executor makes of items; raises BrokenProcessPool where a process has died."""
    futures: dict[Future[WatchedLog], int] = {
        executor.submit(watch_in_worker, settings, item): k for k, item in items.items()
    }
    for future in as_completed(futures):
        k = futures[future]
        try:
            yield k, future.result()
        except BrokenProcessPool:
            raise
        except Exception as error:  # of what brings items and results to and fro
            yield k, WatchedLog(items[k].name, error=f"{type(error).__name__}: {error}")


def _in_processes(settings: bytes, items: Sequence[Item], jobs: int) -> Iterator[Result]:
    """In processes; if one dies, go on with one at a time, so that it is known whose fault it is.

    With one process items are watched in order: the first that is left is the one at which it died.
    """
    left = dict(enumerate(items))
    while left:
        try:
            with _processes(min(jobs, len(left))) as executor:
                for k, found in _submitted(executor, settings, dict(left)):
                    del left[k]
                    yield k, found
        except BrokenProcessPool:
            if jobs == 1:
                k = next(iter(left))
                yield k, WatchedLog(left.pop(k).name, error=_DIED)
            jobs = 1


@contextmanager
def _processes(jobs: int) -> Iterator[Executor]:
    """Processes that end with this one, however it ends.

    They hold the reading end of a pipe of which only this process has the other: its end is theirs.
    """
    context = multiprocessing.get_context("spawn")
    reading, writing = context.Pipe(duplex=False)
    executor = ProcessPoolExecutor(jobs, context, _begin, (reading,))
    added = [name for name in VARIABLES if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))  # read when numpy is loaded, before `_begin`
    try:
        yield executor
        executor.shutdown()
    finally:
        for name in added:
            os.environ.pop(name, None)
        writing.close()
        executor.shutdown(cancel_futures=True)
        reading.close()


def _begin(parent: Connection) -> None:
    """In a new process: leave ^C to the parent, and end with it."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def wait() -> None:
        parent.poll(None)
        os._exit(1)

    Thread(target=wait, daemon=True).start()


def default_client() -> Client | None:
    """The client of Dask that this program has made its own, if it has."""
    if "distributed" not in sys.modules:
        return None
    from distributed import default_client as found

    try:
        client: Client = found()
        return client
    except ValueError:
        return None


def client_of(address: str) -> Client:
    """A client of the scheduler at an address, to be closed; raises Trouble where there is none."""
    try:
        from distributed import Client
    except ImportError as error:
        raise Trouble(
            "a scheduler needs distributed: pip install distributed, or install"
            " bondgraph-arr[fleet]"
        ) from error
    try:
        client: Client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise Trouble(f"no scheduler of Dask answers at {address}: {error}") from error
    return client
