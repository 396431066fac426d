-- Version 1 of the state database. Later versions are further files, run in turn; this one never changes.

-- One row a path of the drop that was ever looked at.
CREATE TABLE mesh (
    mesh     INTEGER PRIMARY KEY,
    -- Where it stands in the drop. Text where the name is UTF-8, else a blob of its bytes; the same for folder, name,
    -- stem and summary.
    path     NOT NULL UNIQUE,
    folder   NOT NULL,
    name     NOT NULL,
    -- The name without mesh and compression extensions; NULL while nobody knows whether it is a mesh.
    stem,
    -- What its scores are compared along: folder and stem.
    series   TEXT,
    -- File name of the summary that is published, in the same sub-folder of the results; NULL if none is.
    summary,
    -- 1 if the log tells that it is no mesh.
    ignored  INTEGER NOT NULL DEFAULT 0
);
CREATE INDEX mesh_stem ON mesh (folder, stem);
CREATE INDEX mesh_series ON mesh (series);

-- One row a version of a mesh: another size, time or inode under the same path is another version.
CREATE TABLE version (
    version     INTEGER PRIMARY KEY,
    -- The id that stands in the log: a hash of path and version, the same on every run.
    id          TEXT NOT NULL UNIQUE,
    mesh        INTEGER NOT NULL REFERENCES mesh,
    bytes       INTEGER NOT NULL,
    inode       INTEGER NOT NULL,
    -- Nanoseconds since 1970.
    modified_ns INTEGER NOT NULL,
    changed_ns  INTEGER NOT NULL,
    -- claimed: a worker has it, or had it when the daemon died. scored, failed, ignored, quarantined: done with.
    -- waiting: it failed for a reason that may pass, and is tried again. dropped: it changed or went away.
    stage       TEXT NOT NULL,
    -- How often a worker got it, and how often that worker ended abnormally.
    attempts    INTEGER NOT NULL DEFAULT 0,
    abnormal    INTEGER NOT NULL DEFAULT 0,
    -- RFC 3339 in UTC: when a worker last got it, and when its outcome was put down.
    claimed     TEXT,
    ended       TEXT,
    -- Of failures: what sort, and in words.
    kind        TEXT,
    reason      TEXT,
    -- Of scored versions.
    verdict     TEXT,
    format      TEXT,
    xxh3        TEXT,
    nodes       INTEGER,
    elements    INTEGER,
    seconds     REAL
);
CREATE INDEX version_mesh ON version (mesh, version);
CREATE INDEX version_open ON version (stage) WHERE stage IN ('claimed', 'waiting', 'quarantined');

-- One row a scored version and shape.
CREATE TABLE shape (
    version    INTEGER NOT NULL REFERENCES version ON DELETE CASCADE,
    shape      TEXT NOT NULL,
    count      INTEGER NOT NULL,
    inverted   INTEGER NOT NULL,
    degenerate INTEGER NOT NULL,
    -- Area of surface shapes, volume of solids.
    area       REAL,
    volume     REAL,
    PRIMARY KEY (version, shape)
) WITHOUT ROWID;

-- One row a scored version, shape and measure: the history of scores.
CREATE TABLE score (
    version     INTEGER NOT NULL REFERENCES version ON DELETE CASCADE,
    shape       TEXT NOT NULL,
    measure     TEXT NOT NULL,
    -- element, triangular faces, quadrilateral faces
    measured_on TEXT NOT NULL,
    count       INTEGER NOT NULL,
    min         REAL,
    min_element INTEGER NOT NULL,
    max         REAL,
    mean        REAL,
    sd          REAL,
    -- Quantiles: q001 is that of probability 0.001, q95 that of 0.95.
    q001        REAL,
    q01         REAL,
    q05         REAL,
    q50         REAL,
    q95         REAL,
    PRIMARY KEY (version, shape, measure)
) WITHOUT ROWID;

-- Outcomes that stand in the log and not yet here, because the daemon died in between. They are not logged again.
CREATE TABLE logged (
    id    TEXT PRIMARY KEY,
    event TEXT NOT NULL
) WITHOUT ROWID;

-- How far the log's outcomes are put down here: the log file's inode, and bytes from its start. One row.
CREATE TABLE log_mark (
    one    INTEGER PRIMARY KEY CHECK (one = 1),
    inode  INTEGER NOT NULL,
    offset INTEGER NOT NULL
);

-- The history as people ask for it: SELECT ended, min FROM history WHERE series = 'pit' AND measure = 'M31'.
CREATE VIEW history AS
SELECT mesh.series, mesh.path, version.version, version.id, version.ended, version.verdict, version.elements,
       score.shape, score.measure, score.measured_on, score.count, score.min, score.min_element, score.max, score.mean,
       score.sd, score.q001, score.q01, score.q05, score.q50, score.q95, shape.inverted, shape.degenerate
FROM score
JOIN shape USING (version, shape)
JOIN version USING (version)
JOIN mesh USING (mesh);
