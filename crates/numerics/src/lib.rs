//! Roots, Bernstein certificates, Fourier transforms, statistics and smooth integration.
