# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""ROS 2 without ROS: messages over DDS (docs/robots.md). Needs cyclonedds, rosbags and Pillow: pip install 'ovimap[ros]'."""
