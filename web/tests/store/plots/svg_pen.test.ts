import { describe, expect, it } from 'vitest';
import { clipped, SvgPen, svgFile } from '../../../src/store/plots/svg_pen';

describe('SvgPen', () => {
  it('draws lines as a canvas does, with dashes', () => {
    const pen = new SvgPen();
    pen.strokeStyle = '#123';
    pen.lineWidth = 2;
    pen.setLineDash([7, 4]);
    pen.beginPath();
    pen.moveTo(1, 2);
    pen.lineTo(3.14159, 4);
    pen.stroke();
    expect(pen.content).toBe(
      '<path d="M1 2L3.14 4" fill="none" stroke="#123" stroke-width="2" stroke-linejoin="miter" stroke-dasharray="7 4"/>',
    );
  });

  it('begins a shape with its first point, and fills it', () => {
    const pen = new SvgPen();
    pen.fillStyle = 'red';
    pen.beginPath();
    pen.lineTo(0, 0);
    pen.lineTo(1, 0);
    pen.closePath();
    pen.fill();
    expect(pen.content).toBe('<path d="M0 0L1 0Z" fill="red"/>');
  });

  it('draws circles and areas, and nothing without a path', () => {
    const pen = new SvgPen();
    pen.beginPath();
    pen.stroke();
    pen.fill();
    expect(pen.content).toBe('');
    pen.arc(10, 10, 5);
    pen.fill();
    pen.fillRect(1, 2, 3, 4);
    expect(pen.content).toContain('M5 10a5 5 0 1 0 10 0a5 5 0 1 0 -10 0Z');
    expect(pen.content).toContain('<rect x="1" y="2" width="3" height="4" fill="#000"/>');
  });

  it('places text by its alignment, and escapes it', () => {
    const pen = new SvgPen();
    pen.font = '600 20px system-ui';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.fillText('a < b', 50, 10);
    expect(pen.content).toContain('x="50" y="17" text-anchor="middle"');
    expect(pen.content).toContain('font-size="20" font-weight="600"');
    expect(pen.content).toContain('>a &#60; b</text>');
    expect(pen.measureText('four').width).toBeCloseTo(44.8);
  });
});

describe('svgFile', () => {
  it('is a complete file with a background', () => {
    const file = svgFile(100, 50, '#fff', clipped(10, 20, 30, 40, '<g/>'));
    expect(file).toBe(
      '<svg xmlns="http://www.w3.org/2000/svg" width="100" height="50" viewBox="0 0 100 50">' +
        '<rect width="100" height="50" fill="#fff"/>' +
        '<svg x="10" y="20" width="30" height="40"><g/></svg></svg>\n',
    );
  });
});
