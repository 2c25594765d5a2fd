// Short helpers for the page's elements. Texts from files become text nodes only, never HTML.

const SVG = 'http://www.w3.org/2000/svg';

/**
 * Returns a new element. Properties: `text`, `on` (listeners by event), `class`, and attributes; an attribute that is
 * false or null is left out. Children that are not nodes become texts.
 */
export function element(tag, properties = {}, ...children) {
  return filled(document.createElement(tag), properties, children);
}

/** Returns a new SVG element; properties as in element(). */
export function svg(tag, properties = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), properties, children);
}

function filled(node, { text, on = {}, ...attributes }, children) {
  if (text !== undefined) node.textContent = visibleText(text);
  for (const [name, value] of Object.entries(attributes))
    if (value !== false && value !== null && value !== undefined) node.setAttribute(name, value === true ? '' : value);
  for (const [event, listener] of Object.entries(on)) node.addEventListener(event, listener);
  node.append(
    ...children
      .filter((child) => child !== null && child !== undefined && child !== false)
      .map((child) => (child instanceof Node ? child : visibleText(child))),
  );
  return node;
}

/** Returns a text with a visible sign in place of each control character, also of those that turn the direction. */
export function visibleText(text) {
  return String(text).replace(
    /[\u0000-\u0008\u000b-\u001f\u007f-\u009f\u200e\u200f\u202a-\u202e\u2066-\u2069]/g,
    '\ufffd',
  );
}

export const byId = (id) => document.getElementById(id);

/** Copies a text to the clipboard. Returns whether that worked; pages from file:// need the older way. */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = element('textarea', { class: 'aside' });
    area.value = text;
    document.body.append(area);
    area.select();
    const copied = document.execCommand('copy');
    area.remove();
    return copied;
  }
}

/** Offers a text as a file to save. */
export function saveFile(name, text, type) {
  const address = URL.createObjectURL(new Blob([text], { type }));
  element('a', { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** Shows a short message at the bottom of the map for some seconds. */
export function notice(text) {
  const box = byId('notice');
  box.textContent = visibleText(text);
  box.hidden = false;
  clearTimeout(notice.timer);
  notice.timer = setTimeout(() => {
    box.hidden = true;
  }, 3500);
}

/** Returns a button that copies the text of textOf() and shows for a moment whether that worked. */
export function copyButton(label, textOf) {
  const button = element('button', { type: 'button', text: label });
  button.addEventListener('click', async () => {
    const copied = await copyText(textOf());
    button.textContent = copied ? 'Copied' : 'Copying is not allowed here';
    setTimeout(() => {
      button.textContent = label;
    }, 1500);
  });
  return button;
}
