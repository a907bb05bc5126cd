// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "program.h"

int main(int argc, char** argv) {
  return ovimap::apps::Program().run({argv + 1, argv + argc});
}
