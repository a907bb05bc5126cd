// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks a hot loop that the compiler vectorises: built once for the baseline processor and once
/// for AVX2, chosen when the program starts. Both give the same bits (no fused multiply-add).
/// Sanitizers cannot intercept the start-up choice, so they get the baseline alone.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define OVIMAP_VECTORIZE __attribute__((flatten, target_clones("avx2", "default")))
#else
#define OVIMAP_VECTORIZE
#endif

/// Before a loop: what it writes overlaps nothing that it reads.
#if defined(__clang__)
#define OVIMAP_NO_OVERLAP _Pragma("clang loop vectorize(assume_safety)")
#else
#define OVIMAP_NO_OVERLAP _Pragma("GCC ivdep")
#endif
