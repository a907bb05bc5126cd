# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The error that the user can mend: one line, shown without a traceback."""


class ExportError(Exception):
    pass
