// Limits for the content of files, in one table: a small file can describe a scene that exceeds the memory of a usual
// computer. Each limit has its unit and its reason. `pliant --limits N` (set_limit_factor) scales all those with
// `scales`. A program sets it before it opens a file (pliant/content.h).
#pragma once

#include <cstdint>
#include <string>

#include "components/range.h"
#include "runtime/result.h"

namespace pliant {

struct Limit {
  double most = 0.0;        // at factor 1
  const char* unit = "";    // "nodes", "bytes"
  const char* reason = "";  // why there is a limit, and why this value
  bool scales = true;       // false: a fixed limit of the format or implementation, whatever memory there is
};

namespace limits {
inline constexpr double kMiB = 1048576.0;

// Files. Each is kept in memory as a whole.
inline constexpr Limit kFile{2048 * kMiB, "bytes", "a file is held in memory, and lengths in a GLB have 32 bits"};
inline constexpr Limit kImport{512 * kMiB, "bytes", "an importer takes up to 64 times as much"};
inline constexpr Limit kTetFile{512 * kMiB, "bytes", "text is held in memory beside what is read of it"};
inline constexpr Limit kScriptFile{64 * kMiB, "bytes", "a quarter of an hour at 1 kHz"};
inline constexpr Limit kInputFile{16 * kMiB, "bytes", "an event takes some 20"};
inline constexpr Limit kRecordingFile{1024 * kMiB, "bytes", "a replay holds it in memory"};
inline constexpr Limit kPictureFile{512 * kMiB, "bytes", "it is held in memory beside its pixels"};

// Limits of the child process that runs a library, in addition to 64 bytes and a quarter of a microsecond per input
// byte.
inline constexpr Limit kReaderMemory{768 * kMiB, "bytes", "Assimp's and Draco's own structures"};
inline constexpr Limit kReaderTime{4.0, "s of processor time", "a thousand times what small files take"};

// JSON.
inline constexpr Limit kJsonDepth{64, "levels", "trees are copied and written by recursion", false};
inline constexpr Limit kJsonValues{4e6, "JSON values", "each takes up to 100 bytes"};
inline constexpr Limit kElements{1e5, "elements", "each takes up to 5 kB in all that is made of it"};
inline constexpr Limit kAccessors{2e5, "elements", "each takes up to 1.5 kB"};
inline constexpr Limit kName{1000, "bytes", "names stand in every row of forces.csv"};

// Limits for a level built from its files: a mesh can be instanced often, and a small picture can unpack to a large
// one.
inline constexpr Limit kTriangles{67108864, "triangles", "indices of corners have 32 bits", false};
inline constexpr Limit kAddedTriangles{4194304, "triangles beyond those of its meshes", "each takes some 150 bytes"};
inline constexpr Limit kSurfaces{4096, "surfaces and rigid bodies", "each is looked after in every tick or step"};
inline constexpr Limit kSoftBodies{200, "soft bodies", "each is filled with some 2,000 tetrahedra, in 50 ms"};
inline constexpr Limit kHands{4096, "probes and tools", "a recording knows as many", false};
inline constexpr Limit kAddedVertices{4194304, "vertices of surfaces beyond those of its meshes",
                                      "each has a height of its own"};
inline constexpr Limit kDecoded{256 * kMiB, "bytes of accessors beyond a multiple of the buffers",
                                "accessors may share a few bytes"};
inline constexpr Limit kKeys{1e6, "animation keys", "channels may share accessors"};
inline constexpr Limit kScriptRows{4e6, "rows", "each takes 64 bytes"};
inline constexpr Limit kInputRows{1e5, "rows", "a hand makes some hundred events a second"};
inline constexpr Limit kPicturePixels{8192.0 * 8192.0, "pixels", "what GPUs take", false};
inline constexpr Limit kPanoramaPixels{8192.0 * 4096.0, "pixels", "twice as wide as high, as wide as GPUs take", false};
inline constexpr Limit kPictures{512 * kMiB, "bytes of decoded pictures",
                                 "four a pixel, in the level and in the world"};

// Tetrahedra.
inline constexpr Limit kTets{2e6, "tetrahedra",
                             "each of a level's takes some 400 bytes, and 2,000 fill a step of a millisecond"};
inline constexpr Limit kLatticeNodes{16777216, "nodes of a lattice", "each takes some 20 bytes"};
inline constexpr Limit kTetFileNodes{4e6, "nodes", "each takes 24 bytes, its tetrahedra 400"};
inline constexpr Limit kTetFileEntries{5e7, "entries of a section", "each takes up to 32 bytes"};

// Rows that wait to be written while a frame is drawn. Further rows are counted as lost. Also of the poses since time 0
// that a saved state needs: a WebAssembly module does not give memory back, so its states end earlier.
#ifdef __EMSCRIPTEN__
inline constexpr Limit kJournal{4 * kMiB, "bytes of rows", "18 s of three probes at 1 kHz"};
#else
inline constexpr Limit kJournal{64 * kMiB, "bytes of rows", "8 s of thirty probes at 1 kHz"};
#endif
}  // namespace limits

// [1] Range of set_limit_factor.
inline constexpr Range kLimitFactor{1e-6, 1e3};

double limit_factor();

// The limit times the current factor.
std::uint64_t most(const Limit& limit);

// "WHAT 1900000 elements, more than the 100000 that are taken (REASON); CURE, or allow it with --limits 19".
Note beyond(const std::string& what, const Limit& limit, double found, const std::string& cure);

}  // namespace pliant
