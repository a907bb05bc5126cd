# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The normal client: asks for a small resource all the time, each time on a connection of its own, from a process of its
own, and prints a line for each request: when it began, how long it took ("-1": it failed), and how long an echo by
another process took at the same time, which tells how busy the machine is.

Usage: witness.py PORT ECHO_PORT [CERTIFICATE]    with a certificate, which it trusts, over TLS
"""
import http.client
import socket
import ssl
import sys
import time

PAUSE_S = 0.01
PATIENCE_S = 5.0


def trusting(certificate):
    """What a client needs to know of the server; None: it is not encrypted."""
    if certificate is None:
        return None
    context = ssl.create_default_context(cafile=certificate)
    context.check_hostname = False  # it is asked by its address
    return context


def connection_to(port, context, timeout):
    if context is None:
        return http.client.HTTPConnection("127.0.0.1", port, timeout=timeout)
    return http.client.HTTPSConnection("127.0.0.1", port, timeout=timeout, context=context)


def answered(port, context):
    connection = connection_to(port, context, PATIENCE_S)
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


def main(port, echo_port, certificate=None):
    context = trusting(certificate)
    while True:
        begin = time.monotonic()
        succeeded = answered(port, context)
        took_s = time.monotonic() - begin if succeeded else -1.0
        before_echo = time.monotonic()
        echoed(echo_port)
        print(begin, took_s, time.monotonic() - before_echo, flush=True)
        time.sleep(PAUSE_S)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), *sys.argv[3:])
