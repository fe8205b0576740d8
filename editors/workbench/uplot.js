// Of uPlot: the charts of the workbench and of the live page.
export { default as uPlot } from "uplot";
