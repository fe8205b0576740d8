/* FMI 3.0 for co-simulation: types and functions as the standard has them. */

typedef void *fmi3Instance;
typedef void *fmi3FMUState;
typedef void *fmi3InstanceEnvironment;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef bool fmi3Clock;
typedef uint8_t fmi3Byte;
typedef const char *fmi3String;
typedef const fmi3Byte *fmi3Binary;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef int fmi3DependencyKind;
typedef int fmi3IntervalQualifier;
typedef void (*fmi3LogMessageCallback)(
    fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64, fmi3Boolean,
    fmi3Boolean, fmi3Boolean, fmi3Boolean, fmi3Boolean *, fmi3Float64 *);
typedef void (*fmi3LockPreemptionCallback)(void);

#if defined _WIN32
#define SHARED __declspec(dllexport)
#elif defined __GNUC__
#define SHARED __attribute__((visibility("default")))
#else
#define SHARED
#endif
/* Names begin with FMI3_FUNCTION_PREFIX where several FMUs are linked into one program. */
#if defined FMI3_FUNCTION_PREFIX
#define JOINED(a, b) a##b
#define PREFIXED(a, b) JOINED(a, b)
#define FMI(name) PREFIXED(FMI3_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif
#define API(result, name) SHARED result FMI(name)

typedef struct instance {
    component c;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} instance;

static fmi3Status failed(const instance *i)
{
    if (i->log != NULL) {
        i->log(i->environment, fmi3Error, "logStatusError", i->c.said);
    }
    return fmi3Error;
}

static fmi3Status answer(const instance *i, bool good)
{
    return good ? fmi3OK : failed(i);
}

static fmi3Status none(fmi3Instance c, size_t count, const char *what)
{
    instance *i = c;

    return answer(i, count == 0 || refuse(&i->c, "%s has no %s", identifier, what));
}

API(const char *, fmi3GetVersion)(void)
{
    return "3.0";
}

API(fmi3Instance, fmi3InstantiateCoSimulation)(fmi3String name, fmi3String token,
    fmi3String resources, fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events,
    fmi3Boolean early_return, const fmi3ValueReference intermediate[], size_t intermediates,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3IntermediateUpdateCallback update)
{
    instance *i = calloc(1, sizeof *i);

    (void)name, (void)resources, (void)visible, (void)logging;
    (void)early_return, (void)intermediate, (void)intermediates, (void)update;
    if (i == NULL) {
        return NULL;
    }
    i->environment = environment;
    i->log = log;
    component_reset(&i->c);
    if (token == NULL || strcmp(token, identity) != 0) {
        (void)refuse(&i->c, "the token is not that of %s: its modelDescription.xml is of another"
            " version", identifier);
    } else if (events) {
        (void)refuse(&i->c, "%s has no event mode", identifier);
    } else {
        return i;
    }
    (void)failed(i);
    free(i);
    return NULL;
}

static fmi3Instance only_cosimulation(
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    if (log != NULL) {
        log(environment, fmi3Error, "logStatusError", "this FMU is for co-simulation only");
    }
    return NULL;
}

API(fmi3Instance, fmi3InstantiateModelExchange)(fmi3String name, fmi3String token,
    fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging;
    return only_cosimulation(environment, log);
}

API(fmi3Instance, fmi3InstantiateScheduledExecution)(fmi3String name, fmi3String token,
    fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
    fmi3LockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging;
    (void)update, (void)lock, (void)unlock;
    return only_cosimulation(environment, log);
}

API(void, fmi3FreeInstance)(fmi3Instance c)
{
    free(c);
}

API(fmi3Status, fmi3SetDebugLogging)(
    fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[])
{
    (void)c, (void)on, (void)count, (void)categories; /* errors are always told, nothing else is */
    return fmi3OK;
}

API(fmi3Status, fmi3EnterInitializationMode)(fmi3Instance c, fmi3Boolean with_tolerance,
    fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean with_stop, fmi3Float64 stop)
{
    instance *i = c;

    (void)with_stop, (void)stop;
    return answer(i, component_initialize(&i->c, start, with_tolerance, tolerance));
}

API(fmi3Status, fmi3ExitInitializationMode)(fmi3Instance c)
{
    instance *i = c;

    return answer(i, component_start(&i->c));
}

API(fmi3Status, fmi3Terminate)(fmi3Instance c)
{
    instance *i = c;

    return answer(i, component_terminate(&i->c));
}

API(fmi3Status, fmi3Reset)(fmi3Instance c)
{
    component_reset(&((instance *)c)->c);
    return fmi3OK;
}

API(fmi3Status, fmi3DoStep)(fmi3Instance c, fmi3Float64 time, fmi3Float64 step,
    fmi3Boolean no_way_back, fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early,
    fmi3Float64 *last)
{
    instance *i = c;
    const bool good = component_step(&i->c, time, step);

    (void)no_way_back;
    *event = *terminate = *early = false;
    *last = i->c.m.time;
    return answer(i, good);
}

/* fmi3GetFloat64, fmi3SetFloat64 and so on. */
#define ACCESS(Name, kind) \
    API(fmi3Status, fmi3Get##Name)(fmi3Instance c, const fmi3ValueReference reference[], \
        size_t count, fmi3##Name value[], size_t values) \
    { \
        instance *i = c; \
        double number = 0.0; \
        size_t k; \
        if (values != count) { \
            return answer(i, refuse(&i->c, "not as many values as variables")); \
        } \
        for (k = 0; k < count; ++k) { \
            if (!component_get(&i->c, reference[k], kind, &number)) { \
                return failed(i); \
            } \
            value[k] = (fmi3##Name)number; \
        } \
        return fmi3OK; \
    } \
    API(fmi3Status, fmi3Set##Name)(fmi3Instance c, const fmi3ValueReference reference[], \
        size_t count, const fmi3##Name value[], size_t values) \
    { \
        instance *i = c; \
        size_t k; \
        if (values != count) { \
            return answer(i, refuse(&i->c, "not as many values as variables")); \
        } \
        for (k = 0; k < count; ++k) { \
            if (!component_set(&i->c, reference[k], kind, (double)value[k])) { \
                return failed(i); \
            } \
        } \
        return fmi3OK; \
    }

ACCESS(Float64, REAL_TYPE)
ACCESS(Int32, INTEGER_TYPE)
ACCESS(Boolean, BOOLEAN_TYPE)

#define NO_ACCESS(Name) \
    API(fmi3Status, fmi3Get##Name)(fmi3Instance c, const fmi3ValueReference reference[], \
        size_t count, fmi3##Name value[], size_t values) \
    { \
        (void)reference, (void)value, (void)values; \
        return none(c, count, #Name " variables"); \
    } \
    API(fmi3Status, fmi3Set##Name)(fmi3Instance c, const fmi3ValueReference reference[], \
        size_t count, const fmi3##Name value[], size_t values) \
    { \
        (void)reference, (void)value, (void)values; \
        return none(c, count, #Name " variables"); \
    }

NO_ACCESS(Float32)
NO_ACCESS(Int8)
NO_ACCESS(UInt8)
NO_ACCESS(Int16)
NO_ACCESS(UInt16)
NO_ACCESS(UInt32)
NO_ACCESS(Int64)
NO_ACCESS(UInt64)
NO_ACCESS(String)

API(fmi3Status, fmi3GetBinary)(fmi3Instance c, const fmi3ValueReference reference[], size_t count,
    size_t sizes[], fmi3Binary value[], size_t values)
{
    (void)reference, (void)sizes, (void)value, (void)values;
    return none(c, count, "Binary variables");
}

API(fmi3Status, fmi3SetBinary)(fmi3Instance c, const fmi3ValueReference reference[], size_t count,
    const size_t sizes[], const fmi3Binary value[], size_t values)
{
    (void)reference, (void)sizes, (void)value, (void)values;
    return none(c, count, "Binary variables");
}

API(fmi3Status, fmi3GetClock)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, fmi3Clock value[])
{
    (void)reference, (void)value;
    return none(c, count, "clocks");
}

API(fmi3Status, fmi3SetClock)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, const fmi3Clock value[])
{
    (void)reference, (void)value;
    return none(c, count, "clocks");
}

API(fmi3Status, fmi3GetFMUState)(fmi3Instance c, fmi3FMUState *state)
{
    instance *i = c;

    free(*state);
    *state = component_saved(&i->c);
    return answer(i, *state != NULL);
}

API(fmi3Status, fmi3SetFMUState)(fmi3Instance c, fmi3FMUState state)
{
    instance *i = c;

    return answer(i, component_restore(&i->c, state));
}

API(fmi3Status, fmi3FreeFMUState)(fmi3Instance c, fmi3FMUState *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

API(fmi3Status, fmi3SerializedFMUStateSize)(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(memory);
    return fmi3OK;
}

API(fmi3Status, fmi3SerializeFMUState)(
    fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    instance *i = c;

    if (state == NULL || size < sizeof(memory)) {
        return answer(i, refuse(&i->c, "a state takes %lu bytes", (unsigned long)sizeof(memory)));
    }
    memcpy(bytes, state, sizeof(memory));
    return fmi3OK;
}

API(fmi3Status, fmi3DeserializeFMUState)(
    fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    instance *i = c;

    free(*state);
    *state = component_unpacked(&i->c, bytes, size);
    return answer(i, *state != NULL);
}

/* What the standard wants every FMU to export, and this one has nothing of. */
API(fmi3Status, fmi3GetNumberOfVariableDependencies)(
    fmi3Instance c, fmi3ValueReference reference, size_t *count)
{
    (void)reference, (void)count;
    return none(c, 1, "dependencies of single elements");
}

API(fmi3Status, fmi3GetVariableDependencies)(
    fmi3Instance c, fmi3ValueReference dependent, size_t elements[], fmi3ValueReference
    independents[], size_t of[], fmi3DependencyKind kinds[], size_t count)
{
    (void)dependent, (void)elements, (void)independents, (void)of, (void)kinds, (void)count;
    return none(c, 1, "dependencies of single elements");
}

API(fmi3Status, fmi3GetDirectionalDerivative)(
    fmi3Instance c, const fmi3ValueReference unknown[], size_t unknowns, const fmi3ValueReference
    known[], size_t knowns, const fmi3Float64 seed[], size_t seeds, fmi3Float64 sensitivity[],
    size_t sensitivities)
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)seed, (void)seeds,
    (void)sensitivity, (void)sensitivities;
    return none(c, 1, "directional derivatives");
}

API(fmi3Status, fmi3GetAdjointDerivative)(
    fmi3Instance c, const fmi3ValueReference unknown[], size_t unknowns, const fmi3ValueReference
    known[], size_t knowns, const fmi3Float64 seed[], size_t seeds, fmi3Float64 sensitivity[],
    size_t sensitivities)
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)seed, (void)seeds,
    (void)sensitivity, (void)sensitivities;
    return none(c, 1, "adjoint derivatives");
}

API(fmi3Status, fmi3EnterConfigurationMode)(fmi3Instance c)
{
    return none(c, 1, "structural parameters");
}

API(fmi3Status, fmi3ExitConfigurationMode)(fmi3Instance c)
{
    return none(c, 1, "structural parameters");
}

API(fmi3Status, fmi3GetIntervalDecimal)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, fmi3Float64 interval[],
    fmi3IntervalQualifier qualifier[])
{
    (void)reference, (void)count, (void)interval, (void)qualifier;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3GetIntervalFraction)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, fmi3UInt64 counter[],
    fmi3UInt64 resolution[], fmi3IntervalQualifier qualifier[])
{
    (void)reference, (void)count, (void)counter, (void)resolution, (void)qualifier;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3GetShiftDecimal)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, fmi3Float64 shift[])
{
    (void)reference, (void)count, (void)shift;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3GetShiftFraction)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, fmi3UInt64 counter[],
    fmi3UInt64 resolution[])
{
    (void)reference, (void)count, (void)counter, (void)resolution;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3SetIntervalDecimal)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, const fmi3Float64
    interval[])
{
    (void)reference, (void)count, (void)interval;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3SetIntervalFraction)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, const fmi3UInt64
    counter[], const fmi3UInt64 resolution[])
{
    (void)reference, (void)count, (void)counter, (void)resolution;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3SetShiftDecimal)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, const fmi3Float64 shift[])
{
    (void)reference, (void)count, (void)shift;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3SetShiftFraction)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, const fmi3UInt64
    counter[], const fmi3UInt64 resolution[])
{
    (void)reference, (void)count, (void)counter, (void)resolution;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3EnterEventMode)(fmi3Instance c)
{
    return none(c, 1, "event mode");
}

API(fmi3Status, fmi3EvaluateDiscreteStates)(fmi3Instance c)
{
    return none(c, 1, "event mode");
}

API(fmi3Status, fmi3UpdateDiscreteStates)(
    fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate, fmi3Boolean *nominals, fmi3Boolean
    *states, fmi3Boolean *next, fmi3Float64 *time)
{
    (void)again, (void)terminate, (void)nominals, (void)states, (void)next, (void)time;
    return none(c, 1, "event mode");
}

API(fmi3Status, fmi3EnterStepMode)(fmi3Instance c)
{
    return none(c, 1, "event mode");
}

API(fmi3Status, fmi3GetOutputDerivatives)(
    fmi3Instance c, const fmi3ValueReference reference[], size_t count, const fmi3Int32 order[],
    fmi3Float64 value[], size_t values)
{
    (void)reference, (void)count, (void)order, (void)value, (void)values;
    return none(c, 1, "derivatives of outputs");
}

API(fmi3Status, fmi3ActivateModelPartition)(
    fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)
{
    (void)clock, (void)time;
    return none(c, 1, "clocks");
}

API(fmi3Status, fmi3EnterContinuousTimeMode)(fmi3Instance c)
{
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3CompletedIntegratorStep)(
    fmi3Instance c, fmi3Boolean no_way_back, fmi3Boolean *event, fmi3Boolean *terminate)
{
    (void)no_way_back, (void)event, (void)terminate;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3SetTime)(fmi3Instance c, fmi3Float64 time)
{
    (void)time;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3SetContinuousStates)(fmi3Instance c, const fmi3Float64 state[], size_t count)
{
    (void)state, (void)count;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3GetContinuousStates)(fmi3Instance c, fmi3Float64 state[], size_t count)
{
    (void)state, (void)count;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3GetContinuousStateDerivatives)(fmi3Instance c, fmi3Float64 rate[], size_t count)
{
    (void)rate, (void)count;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3GetNominalsOfContinuousStates)(
    fmi3Instance c, fmi3Float64 nominal[], size_t count)
{
    (void)nominal, (void)count;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3GetEventIndicators)(fmi3Instance c, fmi3Float64 indicator[], size_t count)
{
    (void)indicator, (void)count;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3GetNumberOfEventIndicators)(fmi3Instance c, size_t *count)
{
    (void)count;
    return none(c, 1, "model exchange");
}

API(fmi3Status, fmi3GetNumberOfContinuousStates)(fmi3Instance c, size_t *count)
{
    (void)count;
    return none(c, 1, "model exchange");
}
