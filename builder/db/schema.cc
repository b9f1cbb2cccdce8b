// SPDX-License-Identifier: Apache-2.0
#include "builder/db/schema.h"

namespace ds {
namespace {

/// Hashes are 32 hexadecimal digits, so that a person can read the tables with the sqlite3 shell.
constexpr const char* k_tables = R"sql(
CREATE TABLE text (
  hash TEXT PRIMARY KEY,      -- of the body
  body TEXT NOT NULL
) WITHOUT ROWID;
CREATE TABLE input_file (
  path TEXT PRIMARY KEY,
  size_bytes INTEGER NOT NULL, mtime_ns INTEGER NOT NULL, inode INTEGER NOT NULL,
  content TEXT NOT NULL,
  ctime_ns INTEGER NOT NULL DEFAULT 0
) WITHOUT ROWID;
CREATE TABLE geometry (
  content TEXT NOT NULL, reader INTEGER NOT NULL,
  geometry TEXT NOT NULL,     -- hash of places and triangles
  damage TEXT NOT NULL,       -- mended, as JSON array of [name, count]
  uvs TEXT NOT NULL, colors TEXT NOT NULL, normals TEXT NOT NULL,   -- their hashes; 0 for none
  extent TEXT NOT NULL,       -- MeshExtent: JSON array of the least, greatest and mean x y z
  shape TEXT NOT NULL,        -- shape_of
  PRIMARY KEY (content, reader)
) WITHOUT ROWID;
CREATE TABLE image_bounds (   -- of textures' pixels as they are used
  image TEXT NOT NULL,        -- hash of the file's content and of how it is used
  reader INTEGER NOT NULL,
  bounds TEXT NOT NULL,       -- JSON array of the least and greatest red, green, blue
  PRIMARY KEY (image, reader)
) WITHOUT ROWID;
CREATE TABLE sphere (         -- around models as they are normalised
  model TEXT NOT NULL,        -- hash of the model's part of the key
  reader INTEGER NOT NULL,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, radius REAL NOT NULL,
  PRIMARY KEY (model, reader)
) WITHOUT ROWID;
CREATE TABLE product (
  key TEXT PRIMARY KEY,
  kind TEXT NOT NULL,
  object TEXT NOT NULL,
  size_bytes INTEGER NOT NULL,
  sha256 TEXT NOT NULL,
  pixels TEXT NOT NULL,
  tone_map_scale REAL NOT NULL,
  rejected_samples INTEGER NOT NULL,
  relative_error REAL,        -- NULL where nothing is known of it
  seconds REAL NOT NULL,
  device TEXT NOT NULL,
  facts TEXT NOT NULL DEFAULT ''  -- FilmFacts, and PixelCounts as its "pixel_counts"
) WITHOUT ROWID;
CREATE TABLE dataset (
  id TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  recipe TEXT NOT NULL,
  working_folder TEXT NOT NULL,
  overrides TEXT NOT NULL,    -- JSON array of strings
  manifest TEXT NOT NULL
) WITHOUT ROWID;
CREATE TABLE image (
  dataset TEXT NOT NULL, id TEXT NOT NULL,
  model TEXT NOT NULL, material TEXT NOT NULL, environment TEXT NOT NULL,
  camera TEXT NOT NULL, engine TEXT NOT NULL, files TEXT NOT NULL,
  PRIMARY KEY (dataset, id)
) WITHOUT ROWID;
CREATE TABLE placed (
  dataset TEXT NOT NULL, path TEXT NOT NULL,
  image TEXT NOT NULL, kind TEXT NOT NULL,
  product TEXT NOT NULL, object TEXT NOT NULL,
  size_bytes INTEGER NOT NULL, mtime_ns INTEGER NOT NULL,
  inode INTEGER NOT NULL,     -- 0: the file was not seen whole since it was recorded
  ctime_ns INTEGER NOT NULL DEFAULT 0,
  PRIMARY KEY (dataset, path)
) WITHOUT ROWID;
CREATE TABLE known (            -- what a program found out and need not again
  program TEXT NOT NULL,        -- another one may find otherwise
  question TEXT NOT NULL, answer TEXT NOT NULL,
  PRIMARY KEY (program, question)
) WITHOUT ROWID;
CREATE TABLE build (
  number INTEGER PRIMARY KEY,
  dataset TEXT NOT NULL,
  started_at TEXT NOT NULL, host TEXT NOT NULL, process INTEGER NOT NULL, device TEXT NOT NULL,
  outcome TEXT NOT NULL,
  images INTEGER NOT NULL, built INTEGER NOT NULL, reused INTEGER NOT NULL, failed INTEGER NOT NULL,
  traced_samples INTEGER NOT NULL,
  seconds REAL NOT NULL
);
CREATE INDEX build_dataset ON build (dataset);
CREATE INDEX product_rejected ON product (key)
  WHERE rejected_samples > 0 AND kind = 'image';
CREATE INDEX product_capped ON product (key)
  WHERE instr(facts, '"capped":true') > 0 AND kind = 'image';
PRAGMA user_version = 12;
)sql";
static_assert(k_schema_version == 12, "the last line of k_tables states the version too");

/// From version 1 to 2.
constexpr const char* k_add_facts = R"sql(
ALTER TABLE product ADD COLUMN facts TEXT NOT NULL DEFAULT '';
)sql";

/// From version 3 to 4.
constexpr const char* k_add_ctime = R"sql(
ALTER TABLE input_file ADD COLUMN ctime_ns INTEGER NOT NULL DEFAULT 0;
ALTER TABLE placed ADD COLUMN ctime_ns INTEGER NOT NULL DEFAULT 0;
)sql";

/// From version 4 to 5.
constexpr const char* k_add_sphere = R"sql(
CREATE TABLE sphere (
  model TEXT NOT NULL, reader INTEGER NOT NULL,
  x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, radius REAL NOT NULL,
  PRIMARY KEY (model, reader)
) WITHOUT ROWID;
)sql";

/// From version 5 to 6. Pictures with samples left out are few, and are looked for in every plan.
constexpr const char* k_add_rejected = R"sql(
CREATE INDEX IF NOT EXISTS product_rejected ON product (key)
  WHERE rejected_samples > 0 AND kind = 'image';
)sql";

/// From version 6 to 7. Likewise of pictures that did not reach their error, in every build.
constexpr const char* k_add_capped = R"sql(
CREATE INDEX IF NOT EXISTS product_capped ON product (key)
  WHERE instr(facts, '"capped":true') > 0 AND kind = 'image';
)sql";

/// From version 11, and of any before it, to 12: what stood of models tells too little of them.
constexpr const char* k_new_geometry = R"sql(
DROP TABLE geometry;
CREATE TABLE geometry (
  content TEXT NOT NULL, reader INTEGER NOT NULL, geometry TEXT NOT NULL, damage TEXT NOT NULL,
  uvs TEXT NOT NULL, colors TEXT NOT NULL, normals TEXT NOT NULL, extent TEXT NOT NULL,
  shape TEXT NOT NULL,
  PRIMARY KEY (content, reader)
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS image_bounds (
  image TEXT NOT NULL, reader INTEGER NOT NULL, bounds TEXT NOT NULL,
  PRIMARY KEY (image, reader)
) WITHOUT ROWID;
)sql";

/// From version 8 to 9, and the version itself.
constexpr const char* k_add_known = R"sql(
CREATE TABLE IF NOT EXISTS known (
  program TEXT NOT NULL,
  question TEXT NOT NULL, answer TEXT NOT NULL,
  PRIMARY KEY (program, question)
) WITHOUT ROWID;
PRAGMA user_version = 12;
)sql";

std::int64_t user_version(Connection& connection) {
  Statement statement = connection.prepare("PRAGMA user_version");
  statement.step();
  return statement.integer(0);
}

bool has_tables(Connection& connection) {
  Statement statement = connection.prepare("SELECT 1 FROM sqlite_schema LIMIT 1");
  return statement.step();
}

}  // namespace

void prepare_schema(Connection& connection, const std::string& name) {
  if (user_version(connection) == k_schema_version) return;
  // A second look under the write lock: another process may be making the tables now.
  Transaction transaction(connection);
  const std::int64_t version = user_version(connection);
  if (version == k_schema_version) return;
  if (version > k_schema_version)
    fail(ErrorKind::io, "{}: wanted a database of version {}, found {}: made by a newer dsbuild",
         name, k_schema_version, version);
  if (version > 0) {
    if (version < 2) connection.execute(k_add_facts);
    if (version < 4) connection.execute(k_add_ctime);
    if (version < 5) connection.execute(k_add_sphere);
    if (version < 6) connection.execute(k_add_rejected);
    if (version < 7) connection.execute(k_add_capped);
    connection.execute(k_new_geometry);
    connection.execute(k_add_known);
    transaction.commit();
    return;
  }
  if (version != 0 || has_tables(connection))
    throw DamagedDatabase(
        fmt::format("{}: the database is damaged: it is no database of dsbuild", name));
  connection.execute(k_tables);
  transaction.commit();
}

}  // namespace ds
