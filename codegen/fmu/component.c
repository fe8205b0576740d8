/* What the rest of this file does for its kind of FMU; each says why it fails. */
static bool configure(component *c);
static bool begin(component *c);
static bool advance(component *c, double step);
static bool observe(component *c);

static bool refuse(component *c, const char *format, ...)
{
    va_list values;

    va_start(values, format);
    (void)vsnprintf(c->said, sizeof c->said, format, values);
    va_end(values);
    return false;
}

static void component_reset(component *c)
{
    size_t k;

    memset(&c->m, 0, sizeof c->m);
    memcpy(c->m.identity, identity, sizeof identity);
    c->m.phase = INSTANTIATED;
    c->m.changed = c->m.stale = true;
    c->m.tolerance = TOLERANCE;
    for (k = 0; k < VARIABLES; ++k) {
        c->m.value[k] = variables[k].start;
    }
}

static bool in_phase(component *c, enum phase phase, const char *what)
{
    static const char *const names[] = {
        "before initialization", "during initialization", "after it was initialized",
        "after it was terminated"};

    if (c->m.phase != phase) {
        return refuse(c, "%s is called %s, and belongs %s", what, names[c->m.phase], names[phase]);
    }
    return true;
}

/* Takes new parameters over, and computes outputs that are out of date. */
static bool up_to_date(component *c)
{
    if (c->m.changed) {
        if (!configure(c) || (c->m.phase == INITIALIZING && !begin(c))) {
            return false;
        }
        c->m.changed = false;
    }
    if (c->m.stale) {
        if (!observe(c)) {
            return false;
        }
        c->m.stale = false;
    }
    return true;
}

static bool component_initialize(component *c, double start, bool with_tolerance, double tolerance)
{
    if (!in_phase(c, INSTANTIATED, "initialization")) {
        return false;
    }
    if (!(fabs(start) < HUGE_VAL)) {
        return refuse(c, "the start time %g s is not finite", start);
    }
    if (with_tolerance && !(tolerance > 0.0 && tolerance < 1.0)) {
        return refuse(c, "the tolerance %g is not between 0 and 1", tolerance);
    }
    c->m.time = start;
    c->m.tolerance = with_tolerance ? tolerance : c->m.tolerance;
    c->m.phase = INITIALIZING;
    return true;
}

static bool component_start(component *c)
{
    if (!in_phase(c, INITIALIZING, "the end of initialization") || !up_to_date(c)) {
        return false;
    }
    c->m.phase = STEPPING;
    return true;
}

static bool component_step(component *c, double time, double step)
{
    if (!in_phase(c, STEPPING, "doStep")) {
        return false;
    }
    if (!(step > 0.0 && step < HUGE_VAL)) {
        return refuse(c, "the communication step %g s is not positive and finite", step);
    }
    if (!(fabs(time - c->m.time) <= NEAR * step)) {
        return refuse(c, "doStep begins at %.9g s; the last one ended at %.9g s", time, c->m.time);
    }
    if (!up_to_date(c) || !advance(c, step)) {
        return false;
    }
    c->m.time = time + step;
    return true;
}

static bool component_terminate(component *c)
{
    c->m.phase = TERMINATED;
    return true;
}

/* The variable of a reference, if it has this type. */
static const variable *found(component *c, unsigned reference, enum type type)
{
    static const char *const names[] = {"real number", "whole number", "boolean"};

    if (reference >= VARIABLES) {
        (void)refuse(c, "there is no variable of the value reference %u", reference);
        return NULL;
    }
    if (variables[reference].type != type) {
        (void)refuse(c, "`%s` is no %s", variables[reference].name, names[type]);
        return NULL;
    }
    return &variables[reference];
}

static bool component_get(component *c, unsigned reference, enum type type, double *value)
{
    const variable *v = found(c, reference, type);

    if (v == NULL) {
        return false;
    }
    if (v->role == OUTPUT) {
        if (c->m.phase == INSTANTIATED) {
            return refuse(c, "`%s` has no value before initialization", v->name);
        }
        if (c->m.phase != TERMINATED && !up_to_date(c)) {
            return false;
        }
    }
    *value = v->role == TIME ? c->m.time : c->m.value[reference];
    return true;
}

static bool component_set(component *c, unsigned reference, enum type type, double value)
{
    const variable *v = found(c, reference, type);

    if (v == NULL) {
        return false;
    }
    if (v->role == OUTPUT || v->role == TIME) {
        return refuse(c, "`%s` is computed here and cannot be set", v->name);
    }
    if (c->m.phase == TERMINATED) {
        return refuse(c, "`%s` is set after the FMU was terminated", v->name);
    }
    if (v->role == FIXED && c->m.phase == STEPPING) {
        return refuse(c, "`%s` can only be set before the end of initialization", v->name);
    }
    if (v->role != INPUT && !(fabs(value) < HUGE_VAL)) {
        return refuse(c, "the parameter `%s` takes no %g: give it a finite number", v->name, value);
    }
    c->m.value[reference] = value;
    c->m.changed = c->m.changed || v->role == TUNABLE || v->role == FIXED;
    c->m.stale = true;
    return true;
}

/* A copy of the memory, which who gets it has to free; NULL where there is no room. */
static memory *component_saved(component *c)
{
    memory *kept = malloc(sizeof *kept);

    if (kept == NULL) {
        (void)refuse(c, "there is no memory for another state");
    } else {
        *kept = c->m;
    }
    return kept;
}

static bool component_restore(component *c, const memory *kept)
{
    if (kept == NULL || memcmp(kept->identity, identity, sizeof identity) != 0) {
        return refuse(c, "this is no state of %s", identifier);
    }
    c->m = *kept;
    return true;
}

/* A memory from the bytes of one, to be freed. */
static memory *component_unpacked(component *c, const void *bytes, size_t size)
{
    memory *kept = NULL;

    if (size != sizeof *kept || memcmp(bytes, identity, sizeof identity) != 0) {
        (void)refuse(c, "these %lu bytes are no state of %s", (unsigned long)size, identifier);
        return NULL;
    }
    kept = component_saved(c);
    if (kept != NULL) {
        memcpy(kept, bytes, sizeof *kept);
    }
    return kept;
}
