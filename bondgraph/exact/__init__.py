"""An exact oracle over a prime field: plants, healthy or faulty, and residuals on them."""
