// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ovimap/frames/frame/frame.h"
#include "ovimap/inference/models/image_tensor.h"
#include "ovimap/inference/models/model_folder.h"
#include "ovimap/inference/models/onnx_session.h"
#include "ovimap/inference/sam/thing_cells.h"

namespace ovimap {

/// Finds things where neither depth nor a gap between masks shows one: what lies flat on a table,
/// or is one with what it stands on. A small network reads the features that a promptable network
/// made of the image and, if it can, the depth seen with it (depth_view), and says where to ask
/// that one, and for what box; if it can, it gives masks as well, so that only doubtful ones are
/// asked for (ThingMasks). Trained on rendered rooms alone (tools/models/train_finder.py);
/// one-stage detection by centreness as in FCOS (Tian et al., ICCV 2019), where the centre is the
/// pixel farthest from the thing's border.
class EntityFinder {
 public:
  /// Of a model whose model.yaml describes the network "finder". Throws Error when a tensor's name
  /// or shape is not what it says.
  EntityFinder(const ModelFolder& model, const RuntimeConfig& runtime);

  static bool is_in(const ModelFolder& model) { return model.networks.contains("finder"); }

  /// `embedding` is of the whole square input, of which the colour image of `source` fills the
  /// upper left part as `frame` says. Throws Error when the network fails.
  FinderMaps look(const FloatTensor& embedding, const InputFrame& frame, const Frame& source) const;

 private:
  std::int64_t channels_of(const std::string& output) const;

  std::string file_;                  ///< for messages
  std::string input_, depth_input_;   ///< the latter empty: this finder looks at colour alone
  std::vector<std::string> outputs_;  ///< things; where it gives masks, kernels and basis as well
  int input_size_px_ = 0;
  OnnxSession session_;
};

}  // namespace ovimap
