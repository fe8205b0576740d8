/* FMI 2.0 for co-simulation: types and functions as the standard has them. */

typedef void *fmi2Component;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;
typedef void *fmi2FMUstate;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
    fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated
} fmi2StatusKind;
typedef struct {
    void (*logger)(void *, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(void *, fmi2Status);
    void *componentEnvironment;
} fmi2CallbackFunctions;

#if defined _WIN32
#define SHARED __declspec(dllexport)
#elif defined __GNUC__
#define SHARED __attribute__((visibility("default")))
#else
#define SHARED
#endif
/* Names begin with FMI2_FUNCTION_PREFIX where several FMUs are linked into one program. */
#if defined FMI2_FUNCTION_PREFIX
#define JOINED(a, b) a##b
#define PREFIXED(a, b) JOINED(a, b)
#define FMI(name) PREFIXED(FMI2_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif
#define API(result, name) SHARED result FMI(name)

typedef struct instance {
    component c;
    char name[256];
    fmi2CallbackFunctions callbacks;
} instance;

static fmi2Status failed(const instance *i)
{
    if (i->callbacks.logger != NULL) {
        i->callbacks.logger(i->callbacks.componentEnvironment, i->name, fmi2Error,
            "logStatusError", "%s", i->c.said);
    }
    return fmi2Error;
}

static fmi2Status answer(const instance *i, bool good)
{
    return good ? fmi2OK : failed(i);
}

API(const char *, fmi2GetTypesPlatform)(void)
{
    return "default";
}

API(const char *, fmi2GetVersion)(void)
{
    return "2.0";
}

API(fmi2Component, fmi2Instantiate)(fmi2String name, fmi2Type type, fmi2String guid,
    fmi2String resources, const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
    fmi2Boolean logging)
{
    instance *i = calloc(1, sizeof *i);

    (void)resources, (void)visible, (void)logging;
    if (i == NULL) {
        return NULL;
    }
    if (callbacks != NULL) {
        i->callbacks = *callbacks;
    }
    (void)snprintf(i->name, sizeof i->name, "%s", name == NULL ? "" : name);
    component_reset(&i->c);
    if (type != fmi2CoSimulation) {
        (void)refuse(&i->c, "%s is for co-simulation only", identifier);
    } else if (guid == NULL || strcmp(guid, identity) != 0) {
        (void)refuse(&i->c, "the GUID is not that of %s: its modelDescription.xml is of another"
            " version", identifier);
    } else {
        return i;
    }
    (void)failed(i);
    free(i);
    return NULL;
}

API(void, fmi2FreeInstance)(fmi2Component c)
{
    free(c);
}

API(fmi2Status, fmi2SetDebugLogging)(
    fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[])
{
    (void)c, (void)on, (void)count, (void)categories; /* errors are always told, nothing else is */
    return fmi2OK;
}

API(fmi2Status, fmi2SetupExperiment)(fmi2Component c, fmi2Boolean with_tolerance,
    fmi2Real tolerance, fmi2Real start, fmi2Boolean with_stop, fmi2Real stop)
{
    instance *i = c;

    (void)with_stop, (void)stop;
    if (!component_initialize(&i->c, start, with_tolerance != 0, tolerance)) {
        return failed(i);
    }
    i->c.m.phase = INSTANTIATED; /* until fmi2EnterInitializationMode */
    return fmi2OK;
}

API(fmi2Status, fmi2EnterInitializationMode)(fmi2Component c)
{
    instance *i = c;

    return answer(i, component_initialize(&i->c, i->c.m.time, false, 0.0));
}

API(fmi2Status, fmi2ExitInitializationMode)(fmi2Component c)
{
    instance *i = c;

    return answer(i, component_start(&i->c));
}

API(fmi2Status, fmi2Terminate)(fmi2Component c)
{
    instance *i = c;

    return answer(i, component_terminate(&i->c));
}

API(fmi2Status, fmi2Reset)(fmi2Component c)
{
    component_reset(&((instance *)c)->c);
    return fmi2OK;
}

API(fmi2Status, fmi2DoStep)(
    fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_way_back)
{
    instance *i = c;

    (void)no_way_back;
    return answer(i, component_step(&i->c, time, step));
}

API(fmi2Status, fmi2CancelStep)(fmi2Component c)
{
    instance *i = c;

    return answer(i, refuse(&i->c, "a step is over when doStep returns: none can be cancelled"));
}

/* fmi2GetReal, fmi2SetReal and so on. */
#define ACCESS(Name, type, kind) \
    API(fmi2Status, fmi2Get##Name)( \
        fmi2Component c, const fmi2ValueReference reference[], size_t count, type value[]) \
    { \
        instance *i = c; \
        double number = 0.0; \
        size_t k; \
        for (k = 0; k < count; ++k) { \
            if (!component_get(&i->c, reference[k], kind, &number)) { \
                return failed(i); \
            } \
            value[k] = (type)number; \
        } \
        return fmi2OK; \
    } \
    API(fmi2Status, fmi2Set##Name)( \
        fmi2Component c, const fmi2ValueReference reference[], size_t count, const type value[]) \
    { \
        instance *i = c; \
        size_t k; \
        for (k = 0; k < count; ++k) { \
            if (!component_set(&i->c, reference[k], kind, (double)value[k])) { \
                return failed(i); \
            } \
        } \
        return fmi2OK; \
    }

ACCESS(Real, fmi2Real, REAL_TYPE)
ACCESS(Integer, fmi2Integer, INTEGER_TYPE)
ACCESS(Boolean, fmi2Boolean, BOOLEAN_TYPE)

static fmi2Status none(fmi2Component c, size_t count, const char *what)
{
    instance *i = c;

    return answer(i, count == 0 || refuse(&i->c, "%s has no %s", identifier, what));
}

API(fmi2Status, fmi2GetString)(
    fmi2Component c, const fmi2ValueReference reference[], size_t count, fmi2String value[])
{
    (void)reference, (void)value;
    return none(c, count, "texts");
}

API(fmi2Status, fmi2SetString)(
    fmi2Component c, const fmi2ValueReference reference[], size_t count, const fmi2String value[])
{
    (void)reference, (void)value;
    return none(c, count, "texts");
}

API(fmi2Status, fmi2GetFMUstate)(fmi2Component c, fmi2FMUstate *state)
{
    instance *i = c;

    free(*state);
    *state = component_saved(&i->c);
    return answer(i, *state != NULL);
}

API(fmi2Status, fmi2SetFMUstate)(fmi2Component c, fmi2FMUstate state)
{
    instance *i = c;

    return answer(i, component_restore(&i->c, state));
}

API(fmi2Status, fmi2FreeFMUstate)(fmi2Component c, fmi2FMUstate *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

API(fmi2Status, fmi2SerializedFMUstateSize)(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(memory);
    return fmi2OK;
}

API(fmi2Status, fmi2SerializeFMUstate)(
    fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    instance *i = c;

    if (state == NULL || size < sizeof(memory)) {
        return answer(i, refuse(&i->c, "a state takes %lu bytes", (unsigned long)sizeof(memory)));
    }
    memcpy(bytes, state, sizeof(memory));
    return fmi2OK;
}

API(fmi2Status, fmi2DeSerializeFMUstate)(
    fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    instance *i = c;

    free(*state);
    *state = component_unpacked(&i->c, bytes, size);
    return answer(i, *state != NULL);
}

API(fmi2Status, fmi2GetDirectionalDerivative)(fmi2Component c,
    const fmi2ValueReference unknown[], size_t unknowns, const fmi2ValueReference known[],
    size_t knowns, const fmi2Real change[], fmi2Real found_change[])
{
    (void)unknown, (void)known, (void)knowns, (void)change, (void)found_change;
    return none(c, unknowns, "directional derivatives");
}

API(fmi2Status, fmi2SetRealInputDerivatives)(fmi2Component c,
    const fmi2ValueReference reference[], size_t count, const fmi2Integer order[],
    const fmi2Real value[])
{
    (void)reference, (void)order, (void)value;
    return none(c, count, "derivatives of inputs");
}

API(fmi2Status, fmi2GetRealOutputDerivatives)(fmi2Component c,
    const fmi2ValueReference reference[], size_t count, const fmi2Integer order[],
    fmi2Real value[])
{
    (void)reference, (void)order, (void)value;
    return none(c, count, "derivatives of outputs");
}

/* Steps are over when doStep returns: of their status there is only when the last one ended. */
API(fmi2Status, fmi2GetStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return none(c, 1, "steps that go on after doStep");
}

API(fmi2Status, fmi2GetRealStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Real *value)
{
    instance *i = c;

    if (kind != fmi2LastSuccessfulTime) {
        return none(c, 1, "such status");
    }
    *value = i->c.m.time;
    return fmi2OK;
}

API(fmi2Status, fmi2GetIntegerStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Integer *value)
{
    (void)kind, (void)value;
    return none(c, 1, "such status");
}

API(fmi2Status, fmi2GetBooleanStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Boolean *value)
{
    if (kind != fmi2Terminated) {
        return none(c, 1, "such status");
    }
    *value = 0;
    return fmi2OK;
}

API(fmi2Status, fmi2GetStringStatus)(fmi2Component c, fmi2StatusKind kind, fmi2String *value)
{
    (void)kind, (void)value;
    return none(c, 1, "such status");
}
