// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace ovimap::python {

/// A line of the library as Python's users need it: where it names an option of the program, the
/// argument of the same meaning stands. What is in backticks is for a shell and stays.
std::string in_python_words(const std::string& line);

}  // namespace ovimap::python
