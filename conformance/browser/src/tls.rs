//! TLS with a certificate that is made for one run.
//!
//! Browsers give WebGPU to secure contexts alone: pages of the machine itself, and pages by https. Nobody vouches for the certificate, so the browser warns;
//! whoever opens the page compares the fingerprint that the browser shows with the one that is printed.

use rcgen::{CertificateParams, DistinguishedName, DnType, KeyPair};
use sha2::{Digest as _, Sha256};
use std::net::IpAddr;
use std::sync::Arc;
use tokio_rustls::TlsAcceptor;
use tokio_rustls::rustls::ServerConfig;
use tokio_rustls::rustls::crypto::ring::default_provider;
use tokio_rustls::rustls::pki_types::PrivateKeyDer;

/// What encrypts connections to an address, with a certificate for it, and the certificate's fingerprint.
///
/// # Errors
/// Where no certificate can be made; in words.
pub(crate) fn certified(address: IpAddr) -> Result<(TlsAcceptor, String), String> {
    let key = KeyPair::generate().map_err(|error| error.to_string())?;
    let mut params = CertificateParams::new(vec![address.to_string()]).map_err(|error| error.to_string())?;
    params.distinguished_name = DistinguishedName::new();
    params.distinguished_name.push(DnType::CommonName, "lightmeter, for one run");
    let certificate = params.self_signed(&key).map_err(|error| error.to_string())?.der().clone();
    let fingerprint = fingerprint(&certificate);
    let key = PrivateKeyDer::try_from(key.serialize_der()).map_err(ToString::to_string)?;
    let config = ServerConfig::builder_with_provider(Arc::new(default_provider()))
        .with_safe_default_protocol_versions()
        .and_then(|builder| builder.with_no_client_auth().with_single_cert(vec![certificate], key));
    Ok((TlsAcceptor::from(Arc::new(config.map_err(|error| error.to_string())?)), fingerprint))
}

/// SHA-256 as browsers show it: `AB:CD:…`.
fn fingerprint(certificate: &[u8]) -> String {
    let bytes: Vec<String> = Sha256::digest(certificate).iter().map(|byte| format!("{byte:02X}")).collect();
    bytes.join(":")
}
