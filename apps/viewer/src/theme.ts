// Dark or light theme: that of the system, until the user chooses one.

const system = matchMedia("(prefers-color-scheme: dark)");
let chosen: boolean | undefined;

export const isDark = (): boolean => chosen ?? system.matches;

export function onTheme(apply: (isDark: boolean) => void): void {
  const update = () => {
    document.documentElement.dataset.theme = isDark() ? "dark" : "light";
    apply(isDark());
  };
  system.addEventListener("change", update);
  listeners.push(update);
  update();
}

export function toggleTheme(): void {
  chosen = !isDark();
  for (const listener of listeners) listener();
}

const listeners: (() => void)[] = [];

export function ground(): string {
  return getComputedStyle(document.documentElement).getPropertyValue("--ground").trim();
}
