/**
 * @template {Element} T
 * @param {string} id
 * @param {new () => T} type  what index.html has under that id
 * @returns {T}
 */
export function element(id, type) {
  const found = document.getElementById(id);
  if (!(found instanceof type)) {
    throw new Error(`expected #${id} in index.html to be a ${type.name}, found ${found ? found.nodeName : "nothing"}`);
  }
  return found;
}

/**
 * Sets a text only where it differs: what is set is read out, selected and laid out anew.
 * @param {Element} node
 * @param {string} text
 */
export function set_text(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/**
 * An icon of index.html's sheet.
 * @param {string} name
 * @returns {SVGSVGElement}
 */
export function icon(name) {
  const kSvg = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(kSvg, "svg");
  const use = document.createElementNS(kSvg, "use");
  use.setAttribute("href", `#icon-${name}`);
  svg.setAttribute("class", "icon");
  svg.setAttribute("aria-hidden", "true");
  svg.append(use);
  return svg;
}
