def _near_tanh(x: float) -> float:
    """tanh to {{ near.bound }}: a quotient of polynomials in the square of x."""
    square = x * x
    if square > {{ near.far }}:
        return -1.0 if x < 0.0 else 1.0
    above = {{ near.above[0] }}
    below = square + {{ near.below[1] }}
{% for factor in near.above[1:] %}
    above = above * square + {{ factor }}
{% endfor %}
{% for factor in near.below[2:] %}
    below = below * square + {{ factor }}
{% endfor %}
    return x * above / below
