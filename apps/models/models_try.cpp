// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <numeric>

#include "models_fetch.h"
#include "ovimap/image/codec.h"

namespace ovimap::apps {

namespace {

std::vector<float> numbers(const Embeddings& rows, Eigen::Index row) {
  return {rows.row(row).begin(), rows.row(row).end()};
}

}  // namespace

int try_model(const TryOptions& options) {
  const auto encoder = make_image_text_encoder(options.model, {}, options.model_dirs);
  if (!encoder) throw Error("MODEL is 'none'; name an encoder");
  const RgbImage picture = read_rgb(options.picture);
  const Embeddings image = encoder->encode_images({&picture, 1});
  const Embeddings texts = encoder->encode_texts(options.texts);
  const Eigen::VectorXf cosines = texts * image.row(0).transpose();
  std::vector<Eigen::Index> order(options.texts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return cosines[a] > cosines[b]; });
  nlohmann::json rows = nlohmann::json::array();
  for (const Eigen::Index i : order) {
    const std::string& text = options.texts[static_cast<std::size_t>(i)];
    rows.push_back({{"text", text}, {"cosine", cosines[i]}, {"embedding", numbers(texts, i)}});
    if (!options.json) std::printf("%8.4f  %s\n", cosines[i], text.c_str());
  }
  if (options.json)
    print_json(
        {{"model", encoder->identity().name}, {"embedding", numbers(image, 0)}, {"texts", rows}});
  return kDone;
}

}  // namespace ovimap::apps
