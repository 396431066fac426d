-- Version 2: the summaries themselves, so that a score can be set beside an earlier one in every statistic.

-- One row a scored version whose summary is still kept; `history.keep` says for how long.
CREATE TABLE summary (
    version INTEGER PRIMARY KEY REFERENCES version ON DELETE CASCADE,
    -- The JSON of the summary, as one frame of Zstandard.
    zstd    BLOB NOT NULL
);
