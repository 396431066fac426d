//! Paths in the database, without loss: TEXT where they are UTF-8, so that people can read them, else a BLOB.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::{OsStrExt, OsStringExt};

use rusqlite::ToSql;
use rusqlite::types::{FromSql, FromSqlError, FromSqlResult, ToSqlOutput, ValueRef};

/// A path on its way into the database.
pub struct In<'p>(pub &'p OsStr);

/// A path on its way out.
pub struct Out(pub OsString);

impl<'p, P: AsRef<OsStr> + ?Sized> From<&'p P> for In<'p> {
    fn from(path: &'p P) -> Self {
        Self(path.as_ref())
    }
}

impl ToSql for In<'_> {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(match self.0.to_str() {
            Some(text) => text.into(),
            None => self.0.as_bytes().into(),
        })
    }
}

impl FromSql for Out {
    fn column_result(value: ValueRef<'_>) -> FromSqlResult<Self> {
        match value {
            ValueRef::Text(bytes) | ValueRef::Blob(bytes) => Ok(Self(OsString::from_vec(bytes.to_vec()))),
            _ => Err(FromSqlError::InvalidType),
        }
    }
}

#[cfg(test)]
mod tests {
    use rusqlite::Connection;

    use super::*;

    #[test]
    fn every_name_survives_and_is_found_again() {
        let connection = Connection::open_in_memory().expect("a database");
        connection.execute_batch("CREATE TABLE p (path UNIQUE)").expect("a table");
        for name in [&b"pit.inp"[..], b"a\nb\".inp", b"\xff\xfe.inp", b"12", b"1e3", "\u{e9}".as_bytes()] {
            let name = OsStr::from_bytes(name);
            connection.execute("INSERT INTO p VALUES (?1)", [In(name)]).expect("inserted");
            let query = "SELECT path FROM p WHERE path = ?1";
            let back: Out = connection.query_row(query, [In(name)], |row| row.get(0)).expect("found");
            assert_eq!(back.0, name);
        }
    }
}
