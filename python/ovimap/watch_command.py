# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The command ovimap-watch: standing queries on a map, as lines of JSON and to a webhook (docs/agents.md)."""

from __future__ import annotations

import argparse
import http.client
import ipaddress
import json
import queue
import sys
import threading
import time
import urllib.parse
from collections.abc import Sequence
from typing import Any

from ._ovimap import Error
from .agents import MapFault
from .command_line import DONE, run_command
from .mcp_command import opened_maps
from .watching import HOLD_S, WatchEvent, watch_map

MOST_WAITING = 1000  # events for the webhook
TRIES = 5
FIRST_PAUSE_S = 0.5  # doubled each time
TIMEOUT_S = 10.0


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    return run_command("ovimap-watch", _parser().parse_args(arguments), extra="", packages=())


class Webhook:
    """Sends events to an address, in order, from a thread of its own: watching never waits for it.

    hosts: names that may be sent to beside this machine. Raises Error for others, and for what is no address."""

    def __init__(self, url: str, hosts: Sequence[str] = ()) -> None:
        self._parts = _checked(url, hosts)
        self._waiting: queue.Queue[dict[str, Any] | None] = queue.Queue(MOST_WAITING)
        self._thread = threading.Thread(target=self._work, name="ovimap-webhook", daemon=True)
        self._thread.start()

    def send(self, event: dict[str, Any]) -> None:
        try:
            self._waiting.put_nowait(event)
        except queue.Full:
            _complain(f"the webhook is so slow that {MOST_WAITING} events wait; this one is left out: {json.dumps(event)}")

    def close(self, patience_s: float = TIMEOUT_S) -> None:
        """Waits until all is sent, so long at most."""
        self._waiting.put(None)
        self._thread.join(patience_s)

    def _work(self) -> None:
        while (event := self._waiting.get()) is not None:
            fault = ""
            for attempt in range(TRIES):
                if attempt > 0:
                    time.sleep(FIRST_PAUSE_S * 2 ** (attempt - 1))
                if not (fault := self._post(event)):
                    break
            if fault:
                _complain(f"the webhook did not take an event in {TRIES} tries ({fault}): {json.dumps(event)}")

    def _post(self, event: dict[str, Any]) -> str:
        """What went wrong; empty: it was taken. Redirections are not followed: they could lead anywhere."""
        kind = http.client.HTTPSConnection if self._parts.scheme == "https" else http.client.HTTPConnection
        connection = kind(self._parts.hostname or "", self._parts.port, timeout=TIMEOUT_S)
        path = urllib.parse.urlunsplit(("", "", self._parts.path or "/", self._parts.query, ""))
        try:
            connection.request("POST", path, json.dumps(event).encode(), {"Content-Type": "application/json"})
            status = connection.getresponse().status
        except (OSError, http.client.HTTPException) as fault:
            return str(fault) or type(fault).__name__
        finally:
            connection.close()
        return "" if 200 <= status < 300 else f"it answered {status}"


def _checked(url: str, hosts: Sequence[str]) -> urllib.parse.SplitResult:
    try:
        parts = urllib.parse.urlsplit(url)
        sound = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0 and not set(url) & set(" \r\n\t")
    except ValueError:  # of the port
        sound = False
    if not sound:
        raise Error(f"'{' '.join(url.split())}' is no address of a webhook; give one as http://localhost:9000/found")
    host = (parts.hostname or "").lower()
    try:
        loopback = host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        loopback = False
    if not loopback and host not in [name.lower() for name in hosts]:
        raise Error(f"events go to this machine alone unless told otherwise; to let them go to '{host}' add --webhook-host {host}")
    return parts


def _watch(options: argparse.Namespace) -> int:
    webhook = Webhook(options.webhook, options.webhook_host) if options.webhook else None

    def tell(event: WatchEvent) -> bool:
        line = event.as_dict()
        if event.event == "fault":
            _complain(event.fault)
        print(json.dumps(line), flush=True)
        if webhook is not None:
            webhook.send(line)
        return not (options.once and event.event == "found")

    [backend] = opened_maps([options.map], options.map_token_file)
    try:
        watch_map(backend, _queries(options), tell, hold_s=options.hold)
    except MapFault as fault:
        raise Error(str(fault)) from None
    except (KeyboardInterrupt, BrokenPipeError):  # the latter: who read the lines has gone
        pass
    finally:
        if webhook is not None:
            webhook.close()
    return DONE


def _queries(options: argparse.Namespace) -> list[str]:
    queries: list[str] = list(options.queries)
    if options.file:
        with open(options.file, encoding="utf-8") as lines:
            queries += [line.strip() for line in lines if line.strip()]
    return queries


def _complain(sentence: str) -> None:
    print(f"ovimap-watch: {sentence}", file=sys.stderr, flush=True)


def _seconds(text: str) -> float:
    value = float(text)
    if not 0 <= value <= 3600:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to 3600 seconds")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ovimap-watch", description="tells once when a thing is found in a map, and when it is gone; a line of JSON each")
    parser.add_argument("map", metavar="MAP", help="map file, or address of `ovimap serve` (also --live); NAME=MAP names it")
    parser.add_argument("queries", nargs="*", metavar="WORDS", help='what to watch for, as "fire extinguisher"')
    parser.add_argument("--file", metavar="FILE", help="more of it, one a line")
    parser.add_argument("--once", action="store_true", help="end when the first is found")
    parser.add_argument("--hold", type=_seconds, default=HOLD_S, metavar="SECONDS",
                        help="a verdict on a map that is being made is told when it has stood so long (default: %(default)g)")  # fmt: skip
    parser.add_argument("--map-token-file", metavar="FILE", help="first line: the server's token; else the variable OVIMAP_TOKEN")
    parser.add_argument("--webhook", metavar="URL", help="also POST each event there, on this machine")
    parser.add_argument("--webhook-host", action="append", default=[], metavar="NAME", help="other host that the webhook may be at. Repeatable")
    parser.set_defaults(command=_watch)
    return parser


if __name__ == "__main__":
    sys.exit(main())
