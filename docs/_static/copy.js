// A button that copies each block of code. Of commands it copies those alone, without prompt, comment and output.
const commands = (text) => {
  const lines = text.split("\n");
  const typed = lines.filter((line) => line.startsWith("$ "));
  return typed.length ? typed.map((line) => line.slice(2).replace(/ {2,}#.*$/, "")).join("\n") + "\n" : text;
};

document.addEventListener("DOMContentLoaded", () => {
  if (!navigator.clipboard) return; // a page that was served without encryption
  for (const block of document.querySelectorAll("div.highlight")) {
    const button = document.createElement("button");
    button.className = "copy";
    button.type = "button";
    button.textContent = "Copy";
    button.addEventListener("click", async () => {
      await navigator.clipboard.writeText(commands(block.querySelector("pre").textContent));
      button.textContent = "Copied";
      setTimeout(() => (button.textContent = "Copy"), 1500);
    });
    block.append(button);
  }
});
