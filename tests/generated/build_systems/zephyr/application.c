/* Something of the application, so that a library without a module is none without sources. */
extern int application;
int application;
