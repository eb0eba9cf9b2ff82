/* What a reader meets on an open page; each function returns sentences about what is amiss. */
(() => {
  const LEAST = 4.5, SLACK = 1, SHOWN = 8, WORDS = 5, DARK = 0.1, BRIGHT = 0.7;
  const says = (e, text) => `${e.tagName.toLowerCase()}${e.id ? '#' + e.id : ''}`
    + `${e.getAttribute('class') ? '.' + e.getAttribute('class') : ''} ${text}: `
    + `'${(e.textContent || '').trim().replace(/\s+/g, ' ').slice(0, 50)}'`;
  const some = found => found.slice(0, SHOWN).concat(
    found.length > SHOWN ? [`and ${found.length - SHOWN} more`] : []);
  const every = () => document.body.querySelectorAll('*');

  const paint = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  const seen = new Map();
  const colour = text => {  // any colour of CSS as red, green, blue (0..255) and alpha (0..1)
    if (!seen.has(text)) {
      paint.clearRect(0, 0, 1, 1);
      paint.fillStyle = text;
      paint.fillRect(0, 0, 1, 1);
      const [r, g, b, a] = paint.getImageData(0, 0, 1, 1).data;
      seen.set(text, [r, g, b, a / 255]);
    }
    return seen.get(text);
  };
  const over = ([r, g, b, a], below) =>
    [r, g, b].map((x, n) => x * a + below[n] * (1 - a)).concat(1);
  const light = ([r, g, b]) => [r, g, b].map(x => x / 255)  // WCAG 2.1, relative luminance
    .map(x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4)
    .reduce((sum, x, n) => sum + x * [0.2126, 0.7152, 0.0722][n], 0);
  const ratio = (one, other) => {
    const [high, low] = [light(one), light(other)].sort((a, b) => b - a);
    return (high + 0.05) / (low + 0.05);
  };

  const grounds = new Map();
  const ground = e => {  // the colour behind an element of HTML
    if (!e) return [255, 255, 255, 1];
    if (!grounds.has(e))
      grounds.set(e, over(colour(getComputedStyle(e).backgroundColor), ground(e.parentElement)));
    return grounds.get(e);
  };
  const veils = new Map();
  const veil = e => {  // the opacity of an element and of all that hold it
    if (!e) return 1;
    if (!veils.has(e)) veils.set(e, getComputedStyle(e).opacity * veil(e.parentElement));
    return veils.get(e);
  };
  const behind = e => {  // the same where shapes of a drawing may lie below a text
    const drawing = e.ownerSVGElement, box = e.getBoundingClientRect();
    const at = new DOMPoint(box.x + box.width / 2, box.y + box.height / 2);
    let below = ground(drawing.parentElement);
    for (const shape of drawing.querySelectorAll('path, rect, circle, ellipse, polygon')) {
      if (shape.compareDocumentPosition(e) & Node.DOCUMENT_POSITION_PRECEDING) break;
      const style = getComputedStyle(shape), place = shape.getScreenCTM();
      if (style.fill === 'none' || shape.closest('defs') || !place) continue;
      const [r, g, b, a] = colour(style.fill);
      if (shape.isPointInFill(at.matrixTransform(place.inverse())))
        below = over([r, g, b, a * style.fillOpacity * veil(shape)], below);
    }
    return below;
  };

  return {
    unfold() { document.querySelectorAll('details').forEach(e => { e.open = true; }); },

    wide() {
      const root = document.documentElement, room = root.clientWidth, found = [];
      if (root.scrollWidth > room) found.push(`the page is ${root.scrollWidth} px wide`);
      for (const e of every()) {
        const box = e.getBoundingClientRect(), style = getComputedStyle(e);
        if (box.width && (box.right > room + SLACK || box.left < -SLACK))
          found.push(says(e, `from ${box.left.toFixed()} to ${box.right.toFixed()} px`));
        else if (style.overflowX !== 'visible' && style.display !== 'inline'
            && !(e instanceof SVGElement) && e.scrollWidth > e.clientWidth)
          found.push(says(e, `holds ${e.scrollWidth} px in ${e.clientWidth}`));
        else if (e.tagName === 'text' && box.width) {
          const frame = e.ownerSVGElement.getBoundingClientRect();
          if (box.left < frame.left - SLACK || box.right > frame.right + SLACK
              || box.top < frame.top - SLACK || box.bottom > frame.bottom + SLACK)
            found.push(says(e, 'is cut by the edge of its drawing'));
        }
      }
      return some(found);
    },

    broken() {  // words that a line's end cuts; names of code may be cut, and what is in formulas
      const found = [], range = document.createRange();
      const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
      for (let text = texts.nextNode(); text; text = texts.nextNode()) {
        if (!text.data.trim() || text.parentElement.closest('math, svg, style, pre')) continue;
        for (const word of text.data.matchAll(/(?<![\w\u00ad])\p{L}{2,}(?![\w\u00ad])/gu)) {
          range.setStart(text, word.index);
          range.setEnd(text, word.index + word[0].length);
          const lines = new Set([...range.getClientRects()].map(box => box.top));
          if (lines.size > 1) found.push(says(text.parentElement, `cuts '${word[0]}'`));
        }
      }
      return some(found);
    },

    torn() {  // cells of tables: parts of names that a line's end cuts, symbols beyond their cell
      const found = [], range = document.createRange();
      for (const cell of document.querySelectorAll('td')) {
        const texts = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
        for (let text = texts.nextNode(); text; text = texts.nextNode())
          for (const part of text.data.matchAll(/[A-Za-z0-9]+/g)) {
            range.setStart(text, part.index);
            range.setEnd(text, part.index + part[0].length);
            const boxes = [...range.getClientRects()];
            if (new Set(boxes.map(box => box.top)).size > 1) found.push(says(cell, 'is torn'));
            if (boxes.some(box => box.right > cell.getBoundingClientRect().right + SLACK))
              found.push(says(cell, 'is cut'));
          }
      }
      return some(found);
    },

    faint() {
      grounds.clear();
      veils.clear();
      const found = new Map();
      const night = matchMedia('(prefers-color-scheme: dark)').matches;
      const paper = light(ground(document.body));
      if (night ? paper > DARK : paper < BRIGHT)
        found.set('', `the page is ${night ? 'bright by night' : 'dark by day'}`);
      const judge = (e, ink, below) => {
        const [r, g, b, a] = colour(ink);
        const got = ratio(over([r, g, b, a * veil(e)], below), below);
        const what = `${ink} has a contrast of ${got.toFixed(2)}`;
        if (got < LEAST && !found.has(what)) found.set(what, says(e, what));
      };
      for (const e of every()) {
        if (!e.checkVisibility({ visibilityProperty: true })) continue;
        for (const part of ['::before', '::after']) {
          const style = getComputedStyle(e, part);
          if (/\w/.test(style.content.replace(/^(none|normal)$/, ''))) judge(e, style.color, ground(e));
        }
        if (![...e.childNodes].some(n => n.nodeType === 3 && n.data.trim())) continue;
        if (e.closest('title, desc, style')) continue;
        const style = getComputedStyle(e);
        if (e.ownerSVGElement) judge(e, style.fill, behind(e)); else judge(e, style.color, ground(e));
      }
      return some([...found.values()]);
    },

    structure() {
      const found = [];
      if (!document.documentElement.lang) found.push('the page does not say its language');
      if (!document.title.trim()) found.push('the page has no title');
      let before = 0;
      for (const e of document.querySelectorAll('h1, h2, h3, h4, h5, h6')) {
        const level = +e.tagName[1];
        if (level > before + 1 || (level === 1) !== (before === 0))
          found.push(says(e, `follows a heading of level ${before}`));
        if (!e.textContent.trim()) found.push(says(e, 'is an empty heading'));
        before = level;
      }
      if (!before) found.push('the page has no heading');
      const told = new Set();
      for (const e of document.querySelectorAll('img, svg')) {
        if (e.closest('[aria-hidden="true"]') || e.parentElement.closest('svg')) continue;
        const words = e.tagName === 'img' ? e.alt : e.getAttribute('aria-label')
          || (e.querySelector(':scope > title') || {}).textContent;
        const text = (words || '').trim();
        if (!text) found.push(says(e, 'has no alternative text'));
        else if (text.split(/\s+/).length < WORDS) found.push(`'${text}' does not say what is seen`);
        else if (told.has(text)) found.push(`two pictures are called '${text}'`);
        told.add(text);
        if (e.tagName === 'svg' && e.getAttribute('role') !== 'img')
          found.push(says(e, 'is no image to who cannot see it'));
        if (e.tagName === 'img' && !e.naturalWidth) found.push(says(e, 'shows nothing'));
      }
      const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
      for (const id of new Set(ids.filter((x, n) => ids.indexOf(x) !== n)))
        found.push(`two elements are called '${id}'`);
      return some(found);
    },

    links() { return [...document.querySelectorAll('a[href], area[href]')].map(e => e.getAttribute('href')); },
  };
})()
