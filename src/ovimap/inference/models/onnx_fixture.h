// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Writes ONNX networks of a few nodes, so that tests can compute by hand what they answer.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/inference/models/proto_writer.h"

namespace ovimap {

/// A graph that is put together node by node. Field numbers are those of onnx.proto.
class OnnxGraph {
 public:
  static constexpr int kFloat = 1, kInt64 = 7;

  OnnxGraph& input(const std::string& name, int type, const TensorShape& shape) {
    graph_.bytes(11, tensor(name, type, shape));
    return *this;
  }
  OnnxGraph& output(const std::string& name, const TensorShape& shape) {
    graph_.bytes(12, tensor(name, kFloat, shape));
    return *this;
  }
  /// `attributes` as number_attribute and list_attribute write them.
  OnnxGraph& node(const std::string& operation, const std::vector<std::string>& inputs,
                  const std::string& result, const std::vector<std::string>& attributes = {}) {
    ProtoWriter writer;
    for (const std::string& name : inputs) writer.bytes(1, name);
    writer.bytes(2, result).bytes(4, operation);
    for (const std::string& attribute : attributes) writer.bytes(5, attribute);
    graph_.bytes(1, writer.text());
    return *this;
  }
  std::string file() {
    graph_.bytes(2, "graph");
    return ProtoWriter()
        .number(1, 8)
        .bytes(7, graph_.text())
        .bytes(8, ProtoWriter().bytes(1, "").number(2, 13).text())
        .text();
  }

  static std::string number_attribute(const std::string& name, std::uint64_t value) {
    return ProtoWriter().bytes(1, name).number(3, value).number(20, 2).text();
  }
  static std::string list_attribute(const std::string& name,
                                    const std::vector<std::uint64_t>& values) {
    ProtoWriter writer;
    writer.bytes(1, name);
    for (const std::uint64_t value : values) writer.number(8, value);
    return writer.number(20, 7).text();
  }

 private:
  static std::string tensor(const std::string& name, int type, const TensorShape& shape) {
    ProtoWriter dims;
    for (const std::int64_t size : shape)
      dims.bytes(1, size < 0 ? ProtoWriter().bytes(2, "any").text()
                             : ProtoWriter().number(1, static_cast<std::uint64_t>(size)).text());
    const std::string tensor_type =
        ProtoWriter().number(1, static_cast<std::uint64_t>(type)).bytes(2, dims.text()).text();
    return ProtoWriter().bytes(1, name).bytes(2, ProtoWriter().bytes(1, tensor_type).text()).text();
  }
  ProtoWriter graph_;
};

}  // namespace ovimap
