% A template for Octave, and MATLAB with its standard input: put your own method in place of `advance`, and have it graded.
%
%     shearbed grade --protocol text --command "octave-cli --quiet my_code.m"
%
% A request is one line of numbers: id, du_i/dx_j row by row, r_e, the time in s, the number of steps or 0, the tolerance or 0,
% the number of rods, and p1 p2 p3 of each. The answer is the id and p1 p2 p3 of each rod at that time, or "ID error REASON".
% See docs/src/user/grading.md.
1;

function out = rate(A, p)
  Ap = A * p;
  out = Ap - p .* sum(p .* Ap);
end

% YOUR METHOD: p, a column for each rod, after `steps` equal steps to `time`. Here: RK4 of p' = Ap - p (p.Ap), A = W + Lambda D.
function p = advance(L, r, time, steps, p)
  A = (r^2 * L - L') / (r^2 + 1);
  h = time / steps;
  for k = 1:steps
    k1 = rate(A, p);
    k2 = rate(A, p + h / 2 * k1);
    k3 = rate(A, p + h / 2 * k2);
    k4 = rate(A, p + h * k3);
    p = p + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  end
end

% The next line of standard input, byte by byte as a pipe gives it: fgetl waits for the line after it. Empty at the end.
function line = next_line()
  line = "";
  byte = fread(stdin, 1, "*char");
  while !isempty(byte) && byte != "\n"
    line(end + 1) = byte;
    byte = fread(stdin, 1, "*char");
  end
end

line = next_line();
while !isempty(line)
  x = sscanf(line, "%f");
  L = reshape(x(2:10), 3, 3)';
  steps = x(13);
  if steps == 0
    printf("%d error it takes steps, no tolerance\n", x(1));
  else
    p = advance(L, x(11), x(12), steps, reshape(x(16:end), 3, x(15)));
    printf("%d%s\n", x(1), sprintf(" %.17g", p));
  end
  fflush(stdout);
  line = next_line();
end
