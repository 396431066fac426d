//! The values of parameters: numbers, text, arithmetic and the functions of a pocket calculator, by the rules of Python.
//!
//! Where versions of Python disagree (a whole number divided by one that does not go into it) there is no value.

use std::fmt;

/// Deepest nesting of an expression.
const DEEPEST: usize = 64;
/// Longest text that is a value.
const LONGEST_TEXT: usize = 80;

/// The value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Whole(i64),
    Real(f64),
    Text(String),
}

impl fmt::Display for Value {
    /// As it is put into a data line; it reads back to the same number.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Whole(value) => write!(f, "{value}"),
            Value::Real(value) => write!(f, "{value:?}"),
            Value::Text(text) => f.write_str(text),
        }
    }
}

impl Value {
    fn real(&self) -> Option<f64> {
        match self {
            Value::Whole(value) => Some(*value as f64),
            Value::Real(value) => Some(*value),
            Value::Text(_) => None,
        }
    }

    /// A number that is one.
    fn of(value: f64) -> Option<Self> {
        value.is_finite().then_some(Value::Real(value))
    }
}

/// The value of an expression up to the end of its line or a `#`; nothing where it is not understood.
pub(super) fn value<'v>(text: &[u8], known: impl Fn(&[u8]) -> Option<&'v Value>) -> Option<Value> {
    let mut parser = Parser { text, at: 0, depth: 0, known: &|name| known(name).cloned() };
    let value = parser.sum()?;
    parser.blanks();
    matches!(parser.text.get(parser.at), None | Some(b'#')).then_some(value)
}

struct Parser<'t> {
    text: &'t [u8],
    at: usize,
    depth: usize,
    known: &'t dyn Fn(&[u8]) -> Option<Value>,
}

impl Parser<'_> {
    fn blanks(&mut self) {
        self.at += self.text[self.at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// Goes past `token`, if it stands here.
    fn takes(&mut self, token: &[u8]) -> bool {
        self.blanks();
        let found = self.text[self.at..].starts_with(token);
        self.at += if found { token.len() } else { 0 };
        found
    }

    fn sum(&mut self) -> Option<Value> {
        self.depth += 1;
        let mut value = (self.depth <= DEEPEST).then(|| self.product())??;
        loop {
            if self.takes(b"+") {
                value = pair(value, self.product()?, i64::checked_add, |a, b| a + b)?;
            } else if self.takes(b"-") {
                value = pair(value, self.product()?, i64::checked_sub, |a, b| a - b)?;
            } else {
                self.depth -= 1;
                return Some(value);
            }
        }
    }

    fn product(&mut self) -> Option<Value> {
        let mut value = self.signed()?;
        loop {
            if self.takes(b"//") || self.takes(b"%") {
                return None;
            } else if self.takes(b"*") {
                value = pair(value, self.signed()?, i64::checked_mul, |a, b| a * b)?;
            } else if self.takes(b"/") {
                let whole = |a: i64, b: i64| (b != 0 && a % b == 0).then(|| a / b);
                value = pair(value, self.signed()?, whole, |a, b| a / b)?;
            } else {
                return Some(value);
            }
        }
    }

    fn signed(&mut self) -> Option<Value> {
        self.depth += 1;
        let value = if self.depth > DEEPEST {
            None
        } else if self.takes(b"-") {
            pair(Value::Whole(0), self.signed()?, i64::checked_sub, |_, b| -b)
        } else if self.takes(b"+") {
            self.signed()
        } else {
            self.power()
        };
        self.depth -= 1;
        value
    }

    fn power(&mut self) -> Option<Value> {
        let base = self.atom()?;
        if !self.takes(b"**") {
            return Some(base);
        }
        let whole = |a: i64, b: i64| u32::try_from(b).ok().and_then(|b| a.checked_pow(b));
        pair(base, self.signed()?, whole, f64::powf)
    }

    fn atom(&mut self) -> Option<Value> {
        if self.takes(b"(") {
            let value = self.sum()?;
            return self.takes(b")").then_some(value);
        }
        let rest = &self.text[self.at..];
        match rest.first()? {
            quote @ (b'\'' | b'"') => {
                let text = &rest[1..];
                let text = &text[..text.iter().position(|b| b == quote)?];
                self.at += text.len() + 2;
                let text = std::str::from_utf8(text).ok().filter(|text| text.len() <= LONGEST_TEXT)?;
                Some(Value::Text(text.to_owned()))
            }
            b'0'..=b'9' | b'.' => self.number(),
            b'A'..=b'Z' | b'a'..=b'z' | b'_' => self.name(),
            _ => None,
        }
    }

    fn number(&mut self) -> Option<Value> {
        let rest = &self.text[self.at..];
        let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
        let (value, len) = fast_float2::parse_partial::<f64, _>(rest).ok()?;
        self.at += len;
        if len > digits {
            return Value::of(value);
        }
        std::str::from_utf8(&rest[..len]).ok()?.parse().ok().map(Value::Whole)
    }

    /// A parameter, a constant, or a function of one or two numbers.
    fn name(&mut self) -> Option<Value> {
        let rest = &self.text[self.at..];
        let len = rest.iter().take_while(|b| b.is_ascii_alphanumeric() || **b == b'_').count();
        let name = &rest[..len];
        self.at += len;
        if !self.takes(b"(") {
            let constant = (name == b"pi").then_some(Value::Real(std::f64::consts::PI));
            return (self.known)(name).or(constant);
        }
        let first = self.sum()?;
        let second = if self.takes(b",") { Some(self.sum()?) } else { None };
        if !self.takes(b")") {
            return None;
        }
        match second {
            None => function(name, &first),
            Some(second) => {
                let (a, b) = (first.real()?, second.real()?);
                match name {
                    b"pow" => pair(first, second, |_, _| None, f64::powf),
                    b"atan2" => Value::of(a.atan2(b)),
                    b"min" => Some(if b < a { second } else { first }),
                    b"max" => Some(if b > a { second } else { first }),
                    _ => None,
                }
            }
        }
    }
}

fn function(name: &[u8], of: &Value) -> Option<Value> {
    let x = of.real()?;
    match (name, of) {
        (b"abs", Value::Whole(value)) => return value.checked_abs().map(Value::Whole),
        (b"int", _) => return (x.abs() < 9e15).then_some(Value::Whole(x as i64)),
        _ => {}
    }
    Value::of(match name {
        b"float" => x,
        b"abs" => x.abs(),
        b"sqrt" => x.sqrt(),
        b"sin" => x.sin(),
        b"cos" => x.cos(),
        b"tan" => x.tan(),
        b"asin" => x.asin(),
        b"acos" => x.acos(),
        b"atan" => x.atan(),
        b"exp" => x.exp(),
        b"log" => x.ln(),
        b"log10" => x.log10(),
        _ => return None,
    })
}

/// An operation on two numbers: on whole ones where both are, else on reals.
fn pair(
    a: Value,
    b: Value,
    whole: impl Fn(i64, i64) -> Option<i64>,
    real: impl Fn(f64, f64) -> f64,
) -> Option<Value> {
    match (&a, &b) {
        (Value::Whole(a), Value::Whole(b)) => whole(*a, *b).map(Value::Whole),
        _ => Value::of(real(a.real()?, b.real()?)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluated(text: &str) -> Option<Value> {
        let (width, count) = (Value::Real(2.5), Value::Whole(4));
        value(text.as_bytes(), |name| match name {
            b"width" => Some(&width),
            b"n" => Some(&count),
            _ => None,
        })
    }

    #[test]
    fn arithmetic_is_that_of_python() {
        for (text, expected) in [
            ("10", Value::Whole(10)),
            (" 5.0**2 # squared", Value::Real(25.0)),
            ("width*2", Value::Real(5.0)),
            ("-2**2", Value::Whole(-4)),
            ("2**3**2", Value::Whole(512)),
            ("2 - 3 - 4", Value::Whole(-5)),
            ("(n + 2)/3", Value::Whole(2)),
            ("7/2.", Value::Real(3.5)),
            ("3.0*sin(30*pi/180.0)", Value::Real(3.0 * 30f64.to_radians().sin())),
            ("max(n, width)", Value::Whole(4)),
            ("int(width)", Value::Whole(2)),
            ("1.e-3", Value::Real(0.001)),
            ("'steel'", Value::Text("steel".into())),
        ] {
            assert_eq!(evaluated(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn what_is_in_doubt_has_no_value() {
        let nested = "(".repeat(1000) + "1" + &")".repeat(1000);
        let minus = "-".repeat(1000) + "1";
        for text in [
            "",
            "7/2",
            "7//2",
            "7 % 2",
            "height",
            "1/0",
            "1.0/0",
            "2**-1",
            "9**99",
            "width +",
            "1 2",
            "sin",
            "sin(1",
            "'a",
            "[1, 2]",
            "'a'*2",
            "99999999999999999999",
            "lambda: 1",
            "0x10",
            "sqrt(-1)",
            &nested,
            &minus,
        ] {
            assert_eq!(evaluated(text), None, "{text}");
        }
    }
}
