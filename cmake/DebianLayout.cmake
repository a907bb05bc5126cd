# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Run by CPack on the staged files: what Debian keeps elsewhere, and in other form, than `ovimap manual` writes it.
set(share "${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share")
file(MAKE_DIRECTORY "${share}/zsh/vendor-completions")
file(RENAME "${share}/zsh/site-functions/_ovimap" "${share}/zsh/vendor-completions/_ovimap")
file(REMOVE_RECURSE "${share}/zsh/site-functions")
file(GLOB pages "${share}/man/man1/*.1")
execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)
