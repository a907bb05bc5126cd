# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The normal client: asks for a small resource all the time, each time on a connection of its own, from a process of its
own, and prints a line for each request: when it began, how long it took ("-1": it failed), and how long an echo by
another process took at the same time, which tells how busy the machine is.

Usage: witness.py PORT ECHO_PORT
"""
import http.client
import socket
import sys
import time

PAUSE_S = 0.01
PATIENCE_S = 5.0


def answered(port):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    try:
        connection.request("GET", "/api/map")
        reply = connection.getresponse()
        reply.read()
        return reply.status == 200
    except (OSError, http.client.HTTPException):
        return False
    finally:
        connection.close()


def echoed(port):
    with socket.create_connection(("127.0.0.1", port), timeout=30) as echo:
        echo.sendall(b"?")
        echo.recv(1)


def main(port, echo_port):
    while True:
        begin = time.monotonic()
        succeeded = answered(port)
        took_s = time.monotonic() - begin if succeeded else -1.0
        before_echo = time.monotonic()
        echoed(echo_port)
        print(begin, took_s, time.monotonic() - before_echo, flush=True)
        time.sleep(PAUSE_S)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
