// A table as text for documents: Markdown, LaTeX or CSV.
import { csvLine } from './csv';

export const kTextFormats = ['Markdown', 'LaTeX', 'CSV'] as const;
export type TextFormat = (typeof kTextFormats)[number];

export interface TextTable {
  head: string[];
  /** As shown. */
  rows: string[][];
  /** The last columns, which contain numbers. */
  numbers: number;
}

export function markdownTable({ head, rows, numbers }: TextTable): string {
  const line = (cells: string[]) =>
    `| ${cells.map((cell) => cell.replaceAll('|', '\\|').replaceAll('\n', ' ')).join(' | ')} |\n`;
  const texts = head.length - numbers;
  const rule = `|${head.map((_, i) => (i < texts ? '---|' : '--:|')).join('')}\n`;
  return line(head) + rule + rows.map(line).join('');
}

export function latexTable({ head, rows, numbers }: TextTable): string {
  const line = (cells: string[]) => `  ${cells.map(latexText).join(' & ')} \\\\\n`;
  const columns = 'l'.repeat(head.length - numbers) + 'r'.repeat(numbers);
  return (
    `\\begin{tabular}{${columns}}\n  \\hline\n${line(head)}  \\hline\n` +
    `${rows.map(line).join('')}  \\hline\n\\end{tabular}\n`
  );
}

export function csvTable(head: string[], rows: (string | number)[][]): string {
  return [head, ...rows].map(csvLine).join('');
}

const kLatexNames: Readonly<Record<string, string>> = {
  '\\': '\\textbackslash{}',
  '~': '\\textasciitilde{}',
  '^': '\\textasciicircum{}',
  '−': '$-$',
  '–': '--',
};

function latexText(text: string): string {
  return text.replace(/[\\~^−–&%$#_{}]/g, (found) => kLatexNames[found] ?? `\\${found}`);
}
