# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Mapping many scenes, or one large site, on a Ray cluster: what `ovimap-ray` does (docs/many-maps.md)."""

from .jobs import Job, cluster, run_jobs
from .scenes import scene_jobs
from .scoring import eval_jobs, pool_job
from .site import site_jobs

__all__ = ["Job", "cluster", "eval_jobs", "pool_job", "run_jobs", "scene_jobs", "site_jobs"]
