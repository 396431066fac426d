//! `/metrics`, `/healthz` and `/readyz` over HTTP, on loopback only.

use std::convert::Infallible;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;

use anyhow::Context;
use http_body_util::Full;
use hyper::body::{Bytes, Incoming};
use hyper::header::CONTENT_TYPE;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Method, Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::sync::Semaphore;

use super::heartbeat::Heartbeat;
use super::metrics::Metrics;

/// More connections than this wait.
const CONNECTIONS: usize = 16;

/// A request whose head takes longer to arrive is not answered.
const HEAD: Duration = Duration::from_secs(5);

/// A connection that lasts longer is closed.
const CONNECTION: Duration = Duration::from_secs(60);

/// What requests are answered from.
#[derive(Clone)]
struct Source {
    metrics: Metrics,
    heartbeat: Heartbeat,
    stalled: Duration,
}

/// Listens at `address`, in a thread of its own. `/healthz` fails once the loop has not turned for `stalled`.
pub fn start(
    address: SocketAddr,
    stalled: Duration,
    metrics: Metrics,
    heartbeat: Heartbeat,
) -> anyhow::Result<()> {
    let listener = TcpListener::bind(address).with_context(|| format!("telemetry.listen = \"{address}\""))?;
    listener.set_nonblocking(true)?;
    tracing::info!("metrics at http://{}/metrics", listener.local_addr()?);
    let source = Source { metrics, heartbeat, stalled };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let serve = move || {
        if let Err(error) = runtime.block_on(serve(listener, source)) {
            tracing::error!("metrics are told no more: {error}");
        }
    };
    std::thread::Builder::new().name("metrics".into()).spawn(serve)?;
    Ok(())
}

async fn serve(listener: TcpListener, source: Source) -> std::io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    loop {
        let Ok(place) = Arc::clone(&places).acquire_owned().await else { return Ok(()) };
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(error) => {
                tracing::debug!("a connection was not accepted: {error}");
                // Out of descriptors, perhaps: do not spin.
                tokio::time::sleep(Duration::from_millis(100)).await;
                continue;
            }
        };
        let source = source.clone();
        tokio::spawn(async move {
            let answer = service_fn(move |request: Request<Incoming>| {
                let answer = answer(request.method(), request.uri().path(), &source);
                async move { Ok::<_, Infallible>(answer) }
            });
            let mut http = http1::Builder::new();
            http.timer(TokioTimer::new()).header_read_timeout(HEAD).max_buf_size(8192);
            let connection = http.serve_connection(TokioIo::new(stream), answer);
            // That a client went away or kept us waiting is its own affair.
            let _ = tokio::time::timeout(CONNECTION, connection).await;
            drop(place);
        });
    }
}

fn answer(method: &Method, path: &str, source: &Source) -> Response<Full<Bytes>> {
    if !matches!(*method, Method::GET | Method::HEAD) {
        return text(StatusCode::METHOD_NOT_ALLOWED, "GET only\n".into());
    }
    match path {
        "/metrics" => match source.metrics.text() {
            Ok(metrics) => text(StatusCode::OK, metrics),
            Err(error) => text(StatusCode::INTERNAL_SERVER_ERROR, format!("{error}\n")),
        },
        "/healthz" => {
            let age = source.heartbeat.age();
            let said = format!("the loop last turned {:.1} s ago\n", age.as_secs_f64());
            let well = age < source.stalled;
            text(if well { StatusCode::OK } else { StatusCode::SERVICE_UNAVAILABLE }, said)
        }
        "/readyz" if source.heartbeat.is_ready() => text(StatusCode::OK, "ready\n".into()),
        "/readyz" => text(
            StatusCode::SERVICE_UNAVAILABLE,
            "not ready: before the first scan, degraded, or about to end; see `meshgauge status`\n".into(),
        ),
        "/" => text(StatusCode::OK, "/metrics\n/healthz\n/readyz\n".into()),
        _ => text(StatusCode::NOT_FOUND, "known are /metrics, /healthz and /readyz\n".into()),
    }
}

fn text(status: StatusCode, body: String) -> Response<Full<Bytes>> {
    let mut response = Response::new(Full::new(Bytes::from(body)));
    *response.status_mut() = status;
    let kind = hyper::header::HeaderValue::from_static("text/plain; version=0.0.4; charset=utf-8");
    response.headers_mut().insert(CONTENT_TYPE, kind);
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn healthz_fails_once_the_loop_stands_still_and_is_well_when_it_turns_again() {
        let heartbeat = Heartbeat::new();
        let source = Source {
            metrics: Metrics::new().expect("metrics"),
            heartbeat: heartbeat.clone(),
            stalled: Duration::from_millis(200),
        };
        let status = |path: &str| answer(&Method::GET, path, &source).status().as_u16();
        std::thread::sleep(Duration::from_millis(300));
        assert_eq!(status("/healthz"), 503);
        heartbeat.beat();
        assert_eq!((status("/healthz"), status("/readyz")), (200, 503));
        heartbeat.set_ready(true);
        assert_eq!((status("/readyz"), status("/metrics"), status("/elsewhere")), (200, 200, 404));
        assert_eq!(answer(&Method::POST, "/metrics", &source).status().as_u16(), 405);
    }
}
