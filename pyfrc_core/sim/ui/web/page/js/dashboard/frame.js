// A widget in its place on the grid: its title, what it shows or that nothing is published; and, while a person arranges
// the dashboard, the ways to move it, to change its size and its settings, and to remove it.
import { dashboards } from "#js/dashboard/dashboards.js";
import { KINDS } from "#js/dashboard/kinds.js";
import { isFree, movedBy } from "#js/dashboard/grid.js";
import { isPublished, pathOf } from "#js/dashboard/topics.js";
import { WidgetSettings } from "#js/dashboard/widget_settings.js";
import { Dropdown } from "#js/popup.js";
import { Component, Icon, classes, createRef, html } from "#js/view.js";

const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export function titleOf(widget) {
  if (widget.title) return widget.title;
  return widget.topic ? widget.topic.split("/").pop() : (KINDS[widget.kind]?.title ?? widget.kind);
}

// board: { arranging, chosen: an index, choose(index), cell() → [width, height] in pixels, change(index, changes), remove(index) }
export class WidgetFrame extends Component {
  state = { place: null, blocked: false }; // place: while it is dragged
  element = createRef();

  // As it is in the draft, which may be newer than what is drawn.
  get widget() {
    return dashboards.shown.widgets[this.props.index];
  }

  render({ widget, index, board }, { place, blocked }) {
    const title = titleOf(widget);
    const { x, y, w, h } = place ?? widget;
    const style = { gridColumn: `${x + 1} / span ${w}`, gridRow: `${y + 1} / span ${h}` };
    const { arranging } = board;
    const chosen = arranging && board.chosen === index;
    const { columns, rows } = dashboards.shown;
    const side = y > 0 ? "above" : h < rows ? "below" : "inside"; // of its tools, for fingers
    const edit = arranging && { tabindex: "0", onFocusIn: () => board.choose(index), onPointerDown: this.begin("move"), onPointerMove: this.drag, onPointerUp: this.end, onPointerCancel: this.end, onKeyDown: this.key };
    const help = arranging ? `${title}. Arrow keys move this widget, with Shift they change its size, Delete removes it` : title;
    return html`<section class=${classes({ widget: true, column: true, [`widget-${widget.kind}`]: true, arranging, chosen, blocked })} style=${style} ref=${this.element}
        aria-label=${help} data-topic=${widget.topic} data-kind=${widget.kind} ...${edit || {}}>
      <header class="flex"><span class="widget-title" title=${widget.topic}>${title}</span>
        ${arranging && html`<span class=${`widget-tools ${side}`} onPointerDown=${(event) => event.stopPropagation()} onKeyDown=${(event) => event.key !== "Escape" && event.stopPropagation()}>
          <${Dropdown} label=${html`<${Icon} name="gear" />`} name=${`Settings of ${title}`} title="Settings" className="tool always"
            content=${() => html`<${WidgetSettings} widget=${widget} change=${(changes) => board.change(index, changes)} />`} />
          <button class="tool always" aria-label=${`Remove ${title}`} title="Remove" onClick=${() => board.remove(index)}><${Icon} name="close" /></button></span>`}
      </header>
      <div class="widget-body fill" inert=${arranging}>${this.content(widget, index, title)}</div>
      ${arranging && html`<i class=${classes({ "widget-corner": true, right: x + w === columns, bottom: y + h === rows })} onPointerDown=${this.begin("size")}></i>`}
    </section>`;
  }

  // The one that was added last may be beyond what the grid shows.
  componentDidUpdate(before) {
    const { board, index } = this.props;
    if (board.chosen === index && before.board.chosen !== index) this.show();
  }

  componentDidMount() {
    if (this.props.board.chosen === this.props.index) this.show();
  }

  show() {
    this.element.current.scrollIntoView({ block: "nearest" });
  }

  content(widget, index, title) {
    const kind = KINDS[widget.kind];
    if (!kind) return html`<p class="missing"><span>This page cannot show “${widget.kind}”.</span></p>`;
    const path = pathOf(widget.topic ?? "");
    if (!widget.topic && !widget.more?.length && !kind.alone) return html`<p class="missing"><span>No topic is chosen: “Arrange”, then the settings of this widget.</span></p>`;
    if (widget.topic && !isPublished(path)) return html`<p class="missing"><span>Not published: <code>${widget.topic}</code></span></p>`;
    return html`<${kind.component} key=${widget.kind} id=${`widget ${index}`} widget=${widget} path=${path} title=${title} />`;
  }

  // -- the pointer and the keys

  begin = (what) => (event) => {
    if (event.button !== 0 || this.held) return;
    event.stopPropagation();
    this.element.current.setPointerCapture(event.pointerId);
    this.element.current.focus({ preventScroll: true });
    this.props.board.choose(this.props.index);
    const { x, y, w, h } = this.widget;
    this.held = { what, x, y, w, h, pointer: event.pointerId, from: [event.clientX, event.clientY], cell: this.props.board.cell() };
  };

  drag = (event) => {
    if (event.pointerId !== this.held?.pointer) return;
    const { what, x, y, w, h, from, cell } = this.held;
    const columns = Math.round((event.clientX - from[0]) / cell[0]);
    const rows = Math.round((event.clientY - from[1]) / cell[1]);
    const place = what === "move" ? { x: x + columns, y: y + rows, w, h } : { x, y, w: Math.max(w + columns, 1), h: Math.max(h + rows, 1) };
    // Where another widget is in the way, it stays where it fitted last.
    const free = isFree(dashboards.shown, place, this.props.index);
    if (free) this.setState({ place, blocked: false });
    else if (!this.state.blocked) this.setState({ blocked: true });
  };

  // Only the release changes the dashboard, so that a drag is one step; what the system takes away changes nothing.
  end = (event) => {
    if (event.pointerId !== this.held?.pointer) return;
    const { index, board } = this.props;
    const { place } = this.state;
    this.held = null;
    this.setState({ place: null, blocked: false });
    if (event.type === "pointerup" && place && this.widget && isFree(dashboards.shown, place, index)) board.change(index, place);
  };

  key = (event) => {
    const { index, board } = this.props;
    const { widget } = this;
    const way = WAYS[event.key];
    if (event.key === "Delete") board.remove(index);
    else if (!way) return;
    else if (event.shiftKey) {
      const place = { x: widget.x, y: widget.y, w: widget.w + way[0], h: widget.h + way[1] };
      if (isFree(dashboards.shown, place, index)) board.change(index, place);
    } else {
      const place = movedBy(dashboards.shown, index, way);
      if (place) board.change(index, place);
    }
    event.preventDefault();
    event.stopPropagation();
  };
}
