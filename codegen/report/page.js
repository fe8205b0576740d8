"use strict";
(() => {
  const links = JSON.parse(document.getElementById("links").textContent);
  const told = document.getElementById("told");
  const all = (selector) => [...document.querySelectorAll(selector)];
  let held = false;

  const clear = () => {
    all(".lit").forEach((e) => e.classList.remove("lit"));
    all(".named").forEach((e) => e.classList.remove("named"));
    told.hidden = true;
  };
  const seenBy = (faults) => [...new Set(faults.flatMap((f) => links.residuals[f] || []))];

  const said = (faults, residuals) => {
    const known = faults.filter((f) => links.residuals[f] || links.unseen.includes(f));
    if (!known.length) return "";
    return residuals.length ? `; seen by ${residuals.join(", ")}` : "; no residual sees it";
  };

  const light = (faults, nodes, text) => {
    clear();
    const residuals = seenBy(faults);
    all("[data-fault]").forEach((e) => faults.includes(e.dataset.fault) && e.classList.add("lit"));
    all("[data-node]").forEach((e) => nodes.includes(e.dataset.node) && e.classList.add("lit"));
    all("[data-name]").forEach((e) => faults.includes(e.dataset.name) && e.classList.add("named"));
    all("th[data-residual], .residual[data-residual]").forEach(
      (e) => residuals.includes(e.dataset.residual) && e.classList.add("named"));
    told.textContent = text + (faults.length ? said(faults, residuals) : "");
    told.hidden = false;
  };

  const nodesOf = (fault) => Object.keys(links.elements).filter(
    (n) => links.elements[n].includes(fault));

  const show = (target) => {
    const at = target.closest("[data-node], [data-fault], [data-name]");
    if (!at) return false;
    const { node, fault, name } = at.dataset;
    const one = fault || name;
    const meaning = (f) => (links.meanings[f] ? `${f}: ${links.meanings[f]}` : f);
    if (node) {
      const faults = links.elements[node] || [];
      light(faults, [node], [node, ...faults.filter((f) => f !== node)].join(", "));
    } else light([one], nodesOf(one), meaning(one));
    return true;
  };

  document.addEventListener("mouseover", (e) => {
    if (!held && !show(e.target)) clear();
  });
  document.addEventListener("click", (e) => {
    held = show(e.target);
    if (!held) clear();
  });
  document.addEventListener("keydown", (e) => {
    if (e.key === "Escape") { held = false; clear(); }
  });
  addEventListener("beforeprint", () => { clear(); all("details").forEach((d) => { d.open = true; }); });
})();
