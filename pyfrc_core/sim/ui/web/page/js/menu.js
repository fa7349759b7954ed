// A button that opens a list of actions. Escape or a click elsewhere closes it; arrow keys move in it.
import { Popup } from "#js/popup.js";
import { Icon, classes, html } from "#js/view.js";

export class Menu extends Popup {
  render({ label, title, items, icon, disabled }, { open }) {
    return html`<div class="menu" ref=${this.element} onKeyDown=${this.key}>
      <button class="quiet" aria-haspopup="menu" aria-expanded=${open} title=${title} disabled=${disabled} onClick=${this.toggle}>
        ${icon && html`<${Icon} name=${icon} />`}<span>${label}</span><i class="caret"></i></button>
      ${open && html`<ul class="menu-list" popover="manual" role="menu">
        ${items.map((item, index) => item.separator
          ? html`<li key=${index} class="menu-separator" role="separator"></li>`
          : html`<li key=${index} role="none"><button role=${item.checked === undefined ? "menuitem" : "menuitemcheckbox"}
              aria-checked=${item.checked} disabled=${item.disabled} onClick=${() => this.act(item)}>
              <i class=${classes({ tick: true, on: item.checked })}></i><span>${item.text}</span>
              ${item.note && html`<small>${item.note}</small>`}</button></li>`)}
      </ul>`}
    </div>`;
  }

  act(item) {
    this.close();
    item.act();
  }

  key = (event) => {
    if (!this.state.open) return;
    const buttons = [...this.element.current.querySelectorAll(".menu-list button:not(:disabled)")];
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (event.key === "Escape") {
      this.close();
      this.element.current.querySelector("button").focus();
    } else if (by) buttons[(buttons.indexOf(document.activeElement) + by + buttons.length) % buttons.length]?.focus();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
}
