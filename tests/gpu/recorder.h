// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

/// What this program's tracer asks of OpenCL, written down so that another program can ask the same
/// of another device (tests/gpu/runner.c). A program that links this has its own clCreateBuffer and
/// so on, which go on to the real ones; so what the tracer launches is told nowhere a second time.
///
/// A pack is a folder, which ci/gpu makes one file of:
///   texts/T.cl  programs' texts
///   data.bin    bytes that cases write and expect, each once; cases say where
///   cases.txt   lines of words, one space between them:
///     dsbuild-gpu 1
///     program P T OPTIONS             its text and build options, before it is first run
///     case NAME
///     time COUNT UNIT KERNEL          what its runs of a kernel trace, where they are worth timing
///     buffer B BYTES                  numbered from 0 in each case
///     zero B BYTES
///     write B BYTES AT                data.bin's bytes from AT on
///     run P KERNEL FIRST ITEMS GROUP ARGUMENTS   work-items from FIRST on, in groups of GROUP;
///                                     an argument is bB (buffer B) or vBYTES@AT
///     read B BYTES HASH AT NAME       what it must be then; AT is - where only the hash is kept
///     end
/// HASH: 64-bit FNV-1a over the 32-bit words in place of bytes, 16 hexadecimal digits. Numbers in
/// data.bin are little-endian. Version 1 is the first.
namespace ds::gpu {

/// Of what is read back, arrays up to this size are kept whole and others as their hash.
inline constexpr std::size_t k_whole_bytes = std::size_t{1} << 20;

/// What is asked of OpenCL from here to `end_case` is this case. What is asked between cases is not
/// recorded; so a case must make and write all buffers that it runs with.
void begin_case(std::string_view name);
/// The runs of this kernel in the case trace so many `unit`s, together.
void time_case(std::uint64_t count, std::string_view unit, std::string_view kernel);
void end_case();

/// Writes all cases into the folder, which is made.
void write_pack(const std::filesystem::path& folder);

}  // namespace ds::gpu
