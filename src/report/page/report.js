'use strict';
(() => {
  const sources = 'fill stroke stroke-width stroke-dasharray stroke-linejoin stroke-opacity fill-opacity opacity paint-order ' +
    'font-size font-weight font-family font-variant-numeric text-anchor color';

  const offer = (name, type, content) => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], {type: type}));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  };

  // A drawing as a file of its own: looks as here, whatever style sheet the reader's program has.
  const standalone = svg => {
    const copy = svg.cloneNode(true);
    const there = [copy, ...copy.querySelectorAll('*')];
    [svg, ...svg.querySelectorAll('*')].forEach((element, at) => {
      const style = getComputedStyle(element);
      there[at].setAttribute('style', sources.split(' ').map(key => `${key}:${style.getPropertyValue(key)}`).join(';'));
    });
    const box = svg.viewBox.baseVal;
    copy.setAttribute('width', box.width);
    copy.setAttribute('height', box.height);
    copy.style.background = getComputedStyle(document.body).backgroundColor;
    return new XMLSerializer().serializeToString(copy);
  };

  const savePng = (name, svg) => {
    const scale = 3;
    const image = new Image();
    image.onload = () => {
      const canvas = document.createElement('canvas');
      canvas.width = scale * svg.viewBox.baseVal.width;
      canvas.height = scale * svg.viewBox.baseVal.height;
      const context = canvas.getContext('2d');
      context.fillStyle = getComputedStyle(document.body).backgroundColor;
      context.fillRect(0, 0, canvas.width, canvas.height);
      context.drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob(picture => offer(name + '.png', 'image/png', picture));
    };
    image.src = 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(standalone(svg));
  };

  const cellsOf = table => [...table.rows].map(row => [...row.cells].map(cell => cell.textContent));

  // The rules of plain_cells in report/detail/table_files.cpp, and files of the same bytes.
  const plain = text => {
    const value = text.replaceAll('\u2212', '-');
    if (value === '\u2013') return '';
    if (/^[+-]?\d{1,3}(,\d{3})+(\.\d+)?$/.test(value)) return value.replaceAll(',', '').replace(/^\+/, '');
    return value.replace(/^\+(?=[\d.])/, '');
  };
  const interval = text => /^(\S+) \[(\S+), (\S+)\]$/.exec(text);
  const csv = table => {
    const [head, ...rows] = cellsOf(table);
    const wide = head.map((_, column) => rows.some(row => interval(row[column])));
    const quoted = text => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const several = wide.filter(Boolean).length > 1;
    const lines = [head.flatMap((text, column) => {
      const of = several ? `${text} ` : '';
      return wide[column] ? [text, `${of}low 95 %`, `${of}high 95 %`] : [text];
    })];
    for (const row of rows) {
      lines.push(row.flatMap((text, column) => {
        if (!wide[column]) return [plain(text)];
        const parts = interval(text);
        return parts ? parts.slice(1).map(plain) : [plain(text), '', ''];
      }));
    }
    return lines.map(line => line.map(quoted).join(',') + '\n').join('');
  };

  // The rules of to_latex.
  const escaped = text => {
    const words = {'\\': '\\textbackslash{}', '{': '\\{', '}': '\\}', '&': '\\&', '%': '\\%', '$': '\\$', '#': '\\#', '_': '\\_',
      '~': '\\textasciitilde{}', '^': '\\textasciicircum{}', '<': '$<$', '>': '$>$', '\u2212': '$-$', '\u2013': '--', '\u00b1': '$\\pm$'};
    return [...text].map(letter => words[letter] ?? letter).join('');
  };
  const number = text => {
    const value = text.replaceAll('\u2212', '-');
    const bare = /^[+-]?\d{1,3}(,\d{3})+(\.\d+)?$/.test(value) ? value.replaceAll(',', '') : value;
    return /^[+-]?\d+(\.\d+)?$/.test(bare) ? bare : null;
  };
  const numberOf = cell => number((interval(cell) ?? [cell, cell])[1]);
  const letters = text => [...text].length;
  const linesOf = (text, most) => {
    const lines = [];
    for (const word of text.split(/\s+/).filter(part => part)) {
      if (lines.length > 0 && letters(lines.at(-1)) + 1 + letters(word) <= most) lines.push(`${lines.pop()} ${word}`);
      else lines.push(word);
    }
    return lines;
  };
  const widthsOf = (head, rows) => head.map((text, at) =>
    Math.min(60, Math.max(...linesOf(text, 1).map(letters), ...rows.map(row => letters(row[at])))));
  const latexHead = (text, width) => {
    const lines = linesOf(text, width).map(escaped);
    return lines.length < 2 ? escaped(text) : `\\shortstack{${lines.join('\\\\')}}`;
  };
  const whole = widths => widths.reduce((sum, width) => sum + width + 2, 0);
  const mostUpright = 95;
  const mostTurned = 140;
  const partsOf = (head, rows, words) => {
    const widths = widthsOf(head, rows);
    const first = widths[0];
    const rest = whole(widths) - first;
    if (first + rest <= mostTurned || head.length < 3 || words) return [[head, rows]];
    const room = mostTurned > 2 * first ? mostTurned - first : mostTurned / 2;
    const columns = Math.ceil((head.length - 1) / Math.min(Math.ceil(rest / room), head.length - 1));
    const parts = [];
    for (let from = 1; from < head.length; from += columns) {
      const chosen = cells => [cells[0], ...cells.slice(from, from + columns)];
      parts.push([chosen(head), rows.map(chosen)]);
    }
    return parts;
  };
  const latex = (name, caption, table) => {
    const [head, ...rows] = cellsOf(table);
    const words = table.classList.contains('words');
    const parts = partsOf(head, rows, words);
    return parts.map(([some, of], at) => latexTable(at === 0 ? name : `${name}-${at + 1}`,
      parts.length === 1 ? caption : `${caption} (${at + 1} of ${parts.length})`, some, of, words)).join('');
  };
  const latexTable = (name, caption, head, rows, words) => {
    const widths = widthsOf(head, rows);
    const columns = head.map((_, at) => {
      const cells = at === 0 || words ? [] : rows.map(row => row[at]).filter(cell => numberOf(cell) !== null);
      const numbers = cells.map(numberOf);
      const has = sign => numbers.some(value => value.startsWith(sign));
      const most = of => Math.max(...numbers.map(value => (of(value.replace(/^[+-]/, '').split('.')) ?? '').length));
      const intervals = cells.some(cell => interval(cell));
      if (numbers.length === 0)
        return {type: (at === 0 || words) && rows.some(row => [...row[at]].length > 60) ? 'p{0.7\\linewidth}' : 'l', head: text => text, body: escaped};
      const plus = has('+');
      const format = `${plus ? '+' : has('-') ? '-' : ''}${most(parts => parts[0])}.${most(parts => parts[1])}`;
      const end = text => `\\num{${text.replaceAll('\u2212', '-')}}`;
      return {
        intervals,
        type: `S[table-format=${format}${plus ? ',retain-explicit-plus' : ''}]${intervals ? '@{\\,}l' : ''}`,
        head: text => (intervals ? `\\multicolumn{2}{c}{${text}}` : `{${text}}`),
        body: cell => {
          const text = numberOf(cell) ?? `{${escaped(cell)}}`;
          const parts = interval(cell);
          return text + (!intervals ? '' : parts ? ` & [${end(parts[2])}, ${end(parts[3])}]` : ' &');
        },
      };
    });
    const line = (row, part) => row.map((cell, at) => columns[at][part](cell)).join(' & ') + ' \\\\\n';
    const turned = whole(widths) > mostUpright;
    const kind = turned ? 'sidewaystable' : 'table';
    return `% needs \\usepackage{booktabs,graphicx,${turned ? 'rotating,' : ''}siunitx}\n\\begin{${kind}}\n\\centering\n\\caption{${escaped(caption)}}\n\\label{tab:${name}}\n` +
      '\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n' +
      `\\begin{tabular}{${columns.map(column => column.type).join(' ')}}\n\\toprule\n${line(head.map((text, at) => latexHead(text, widths[at])), 'head')}\\midrule\n` +
      `${rows.map(row => line(row, 'body')).join('')}\\bottomrule\n\\end{tabular}}\n\\end{${kind}}\n`;
  };

  const addButtons = (place, name, ways) => {
    const group = document.createElement('span');
    group.className = 'save';
    for (const [ending, save] of ways) {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = ending.toUpperCase();
      button.setAttribute('aria-label', `Download ${name}.${ending}`);
      button.addEventListener('click', save);
      group.append(button);
    }
    place.append(group);
  };

  for (const figure of document.querySelectorAll('figure[id]')) {
    const svg = figure.querySelector('svg');
    const data = figure.querySelector('table.data');
    const ways = [['svg', () => offer(figure.id + '.svg', 'image/svg+xml', standalone(svg))], ['png', () => savePng(figure.id, svg)]];
    if (data) ways.push(['csv', () => offer(figure.id + '.csv', 'text/csv', csv(data))]);
    addButtons(figure.querySelector('figcaption'), figure.id, ways);
  }
  for (const part of document.querySelectorAll('.table[id]')) {
    const data = part.querySelector('table.data');
    const whole = part.querySelector('table.whole') ?? data;
    const caption = part.querySelector('.caption').textContent;
    const place = document.createElement('div');
    part.append(place);
    addButtons(place, part.id, [['csv', () => offer(part.id + '.csv', 'text/csv', csv(whole))],
      ['tex', () => offer(part.id + '.tex', 'application/x-tex', latex(part.id, caption, data))]]);
  }

  // A table that has become a list of several screens on a phone is shown in part until it is asked for.
  if (matchMedia('(max-width:560px)').matches) {
    for (const part of document.querySelectorAll('.table')) {
      if (part.offsetHeight < 1.5 * innerHeight) continue;
      const button = document.createElement('button');
      button.type = 'button';
      button.className = 'more';
      button.textContent = 'Show the whole table';
      button.addEventListener('click', () => { part.classList.remove('cut'); button.remove(); });
      part.classList.add('cut');
      part.after(button);
    }
  }

  let unfolded = [];
  addEventListener('beforeprint', () => {
    unfolded = [...document.querySelectorAll('details.fold:not([open])')];
    unfolded.forEach(part => { part.open = true; });
  });
  addEventListener('afterprint', () => unfolded.forEach(part => { part.open = false; }));

  const reveal = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let part = target; part; part = part.parentElement) {
      if (part.localName === 'details') part.open = true;
    }
    if (target) target.scrollIntoView();
  };
  addEventListener('hashchange', reveal);
  if (location.hash) reveal();
})();
