"""The middleware's configuration, one file a host and implementation."""
