// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "open_handle.h"

#include <set>
#include <vector>

#include "without_gil.h"

namespace ovimap::python {

namespace {

std::set<OpenHandle*>& open_handles() {
  static auto* handles = new std::set<OpenHandle*>;  // outlives whatever is destroyed at the end
  return *handles;
}

}  // namespace

OpenHandle::OpenHandle() {
  open_handles().insert(this);
}

OpenHandle::~OpenHandle() {
  open_handles().erase(this);
}

void OpenHandle::close_all() {
  const std::set<OpenHandle*> handles = open_handles();
  std::vector<nb::object> kept;
  for (OpenHandle* handle : handles) kept.push_back(handle->self());
  WithoutGil::end();
  const nb::gil_scoped_release release;
  for (OpenHandle* handle : handles) handle->close();
  WithoutGil::await_all();
}

}  // namespace ovimap::python
